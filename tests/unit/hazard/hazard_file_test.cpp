#include "hazard/hazard_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../fresh_folder.h"
#include "core/error.h"

namespace keyblock::hazard {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class ReadHazard : public testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) {
    const std::filesystem::path file = folder_ / "hazard.csv";
    std::ofstream(file) << text;
    return file;
  }

  std::string refusal(const std::string& text, const HazardOptions& options = {}) {
    try {
      read_hazard(written(text), options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

 private:
  FreshFolder folder_;
};

const std::string head =
    "#,,,,\"generated_by='OpenQuake engine 3.16', kind='mean', investigation_time=50.0, imt='PGA'\"\n";
const std::string sites = head +
                          "lon,lat,depth,poe-0.05,poe-0.1,poe-0.2,poe-0.4,poe-0.8\n8.55,47.37,0,0.99995,0.5,"
                          "0.1,0.02,0\n9,47,0,0.9,0.4,0.1,0.01,0.001\n";

TEST_F(ReadHazard, OfOpenQuake) {
  const HazardFile hazard = read_hazard(written(sites), {.site = std::pair(8.551, 47.37)});
  EXPECT_EQ(hazard.intensity, "PGA");
  ASSERT_EQ(hazard.curve.rate.size(), 3U);  // the first has no rate, the last is 0
  EXPECT_NEAR(hazard.curve.rate[1], 2.107210313e-3, 1e-11);
  EXPECT_NEAR(hazard.curve.rate[2], 4.040541463e-4, 1e-12);
  EXPECT_DOUBLE_EQ(hazard.curve.intensity[1], 0.2 * 9.80665);
  EXPECT_DOUBLE_EQ(*hazard.curve.end, 0.8 * 9.80665);
}

TEST_F(ReadHazard, RefusesWhatIsNotMeant) {
  EXPECT_THAT(refusal(sites), HasSubstr("found 2 sites"));
  EXPECT_THAT(refusal(sites, {.site = std::pair(8.0, 47.0)}),
              AllOf(HasSubstr("no site at [8, 47]"), HasSubstr("nearest is [8.55, 47.37]")));
  EXPECT_THAT(refusal(sites, {.site = std::pair(9.0, 47.0), .intensity = "PGV", .from = "risk.toml"}),
              HasSubstr("found a hazard of PGA"));
  std::string fractile = sites;
  fractile.replace(fractile.find("mean"), 4, "quantile-0.84");
  EXPECT_THAT(refusal(fractile), HasSubstr("quantile-0.84"));
  EXPECT_THAT(refusal(head + "lon,lat,depth,poe-0.1\n8,47,0\n"), HasSubstr("hazard.csv:3:1: found 3 fields"));
}

TEST_F(ReadHazard, OfTheUsgs) {
  const std::string curves =
      R"({"response": {"hazards": [{"metadata": {"imt": {"value": "SA0P3"}},
          "data": [{"component": "Fault", "values": {"xs": [0.1], "ys": [1]}},
                   {"component": "Total", "values": {"xs": [0.1, 0.2, 0.4, 0.8], "ys": [1e-2, 3e-3, 5e-4, 0]}}]}]}})";
  const HazardFile hazard = read_hazard(written(curves), {});
  EXPECT_EQ(hazard.intensity, "SA(0.3)");
  EXPECT_DOUBLE_EQ(hazard.curve.intensity[2], 0.4 * 9.80665);
  EXPECT_EQ(hazard.curve.rate[2], 5e-4);
  const std::string older =
      R"({"response": [{"metadata": {"imt": {"value": "PGA"}, "xvalues": [0.1, 0.2, 0.4]},
          "data": [{"component": "Total", "yvalues": [1e-2, 3e-3, 5e-4]}]}]})";
  EXPECT_EQ(read_hazard(written(older), {}).curve.rate.size(), 3U);
  EXPECT_THAT(refusal(older, {.intensity = "PGV"}), HasSubstr("hazards of PGA"));
  EXPECT_THAT(refusal("{\"response\": 1}"), HasSubstr("JSON of the hazard service"));
}

TEST_F(ReadHazard, OfATable) {
  const HazardOptions velocity{
      .site = {}, .intensity = "PGV", .unit = "cm/s", .investigation_time = 1.0, .from = "risk.toml"};
  const HazardFile hazard = read_hazard(written("pgv,poe\n1,0.455386\n10, 0.1\n30, 0.01\n"), velocity);
  EXPECT_NEAR(hazard.curve.rate[0], 0.6076779920, 1e-9);
  EXPECT_DOUBLE_EQ(hazard.curve.intensity[2], 0.3);
  EXPECT_THAT(refusal("1 2\n"), HasSubstr("without the name of its intensity"));
  EXPECT_THAT(refusal("1 2\n", {.intensity = "PGA"}), HasSubstr("without a unit"));
  EXPECT_THAT(refusal("1 2\n", {.intensity = "PGA", .unit = "m/s"}), HasSubstr("the unit m/s"));
  const HazardOptions pga{.site = {}, .intensity = "PGA", .unit = "g", .investigation_time = {}, .from = ""};
  EXPECT_THAT(refusal("0.1 0.2\n0.2 0.1\n0.2 0.05\n", pga),
              HasSubstr("hazard.csv:3:1: found the intensity 0.2 after 0.2"));
  EXPECT_THAT(refusal("0.1 0.2\n0.2 0.3\n0.3 0.05\n", pga), HasSubstr("hazard.csv:2:1: found the rate 0.3"));
  EXPECT_THAT(refusal("0.1 0.2\n0.2 0.1\n0.3 0\n", pga), HasSubstr("found 2 points"));
  EXPECT_THAT(refusal("0.1 0.2\n0.2 strong\n", pga), HasSubstr("hazard.csv:2:1: found 0.2 strong"));
  EXPECT_THAT(refusal("", pga), HasSubstr("an empty file"));
}

}  // namespace
}  // namespace keyblock::hazard
