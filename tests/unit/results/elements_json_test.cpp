#include "results/elements_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/checked_json.h"

namespace keyblock::results {
namespace {

std::vector<record::ElementRecord> two() {
  record::ElementRecord bolt, support;
  bolt.name = "bolt, 1";
  bolt.kind = "bolt";
  bolt.peak_stage = "shaking";
  bolt.present = true;
  bolt.from = {1.0, 2.0};
  bolt.to = {1.0, 5.0};
  bolt.force = -3e3;
  bolt.peak_force = 8e3;
  bolt.peak_time = 1.5;
  bolt.limit = 1e4;
  bolt.spacing = 1.5;
  bolt.force_of_one = -4.5e3;
  bolt.peak_force_of_one = 12e3;
  bolt.ruptured = true;
  support.name = "support[0]";
  support.kind = "support";
  return {bolt, support};
}

TEST(ElementsJson, IsReadAgain) {
  const nlohmann::ordered_json json = elements_json(two(), {});
  EXPECT_EQ(elements_json(read_elements(json), {}), json);
  EXPECT_EQ(json[0].at("utilization"), 0.8);
  EXPECT_TRUE(json[1].at("utilization").is_null());
  EXPECT_TRUE(json[1].at("limit_n_m").is_null());
  EXPECT_EQ(json[0].at("peak_force_n"), 12e3);
  EXPECT_TRUE(json[1].at("peak_force_n").is_null());
  EXPECT_TRUE(json[0].at("has_ruptured").get<bool>());
  EXPECT_TRUE(json[1].at("peak_stage").is_null());
  EXPECT_EQ(elements_json(two(), {100.0, 0.0})[0].at("from"), (std::vector<double>{101.0, 2.0}));
}

TEST(ElementsJson, TableHasTheSame) {
  EXPECT_EQ(element_table(two(), {100.0, 0.0}),
            "name,kind,present,from_x,from_y,to_x,to_y,force_n_m,elongation_m,yielded_m,peak_force_n_m,"
            "peak_time_s,limit_n_m,spacing_m,force_n,peak_force_n,moment_n,shear_n_m,worst_force_n_m,worst_"
            "moment_n,"
            "worst_shear_n_m,worst_utilization,peak_stage\n"
            "\"bolt, 1\",bolt,1,101,2,101,5,-3000,0,0,8000,1.5,10000,1.5,-4500,12000,0,0,,,,,shaking\n"
            "support[0],support,0,100,0,100,0,0,0,0,0,0,,,,,0,0,,,,,\n");
  EXPECT_EQ(element_table({}, {}), "");
}

}  // namespace
}  // namespace keyblock::results
