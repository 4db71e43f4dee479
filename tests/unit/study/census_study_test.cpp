#include "study/census_study.h"

#include <gtest/gtest.h>

#include "core/checked_json.h"
#include "core/error.h"
#include "scenario/parse.h"

namespace keyblock::study {
namespace {

constexpr const char* rock_mass = R"(
title = "Two sets"
section = { azimuth = 90.0 }
domain = { x = [-4.0, 4.0], y = [-4.0, 4.0] }
rock = { density = 2500.0, young = 5e9, poisson = 0.2 }
joints = { friction = 30.0 }
excavation = [ { name = "adit", shape = "circle", center = [0.0, 0.0], diameter = 3.0, chords = 24 } ]
study = { confidence = 0.9 }
[[joint_set]]
name = "J1"
dip = 70.0
dip_direction = 90.0
spacing = { mean = 0.8, std = 0.2, distribution = "normal" }
length = { mean = 5.0, std = 1.0, distribution = "normal" }
gap = 0.1
[[joint_set]]
name = "J2"
dip = 40.0
dip_direction = 270.0
spacing = { mean = 0.9, std = 0.2, distribution = "normal" }
length = { mean = 5.0, std = 1.0, distribution = "normal" }
gap = 0.1
)";

TEST(CensusStudy, IsTheSameForAnyNumberOfThreads) {
  const scenario::Scenario scenario = scenario::parse_scenario_text(rock_mass, "rock.toml");
  const CensusStudy one = take_censuses(scenario, 9, 1.5, 1), three = take_censuses(scenario, 9, 1.5, 3);
  EXPECT_EQ(censuses_json(one).dump(), censuses_json(three).dump());
  EXPECT_EQ(census_csv(one.realizations), census_csv(three.realizations));
  EXPECT_EQ(one.confidence, 0.9);
  EXPECT_EQ(one.failed(), 0U);
  ASSERT_EQ(one.measures.size(), census_measures().size());
  double sum = 0.0;
  for (const RealizationCensus& each : one.realizations) sum += census::totals(each.census).area;
  EXPECT_GT(sum, 0.0);
  EXPECT_NEAR(one.measures[1].mean.value, sum / 9.0, 1e-12);
}

TEST(CensusStudy, EndsWhenItIsAskedTo) {
  const scenario::Scenario scenario = scenario::parse_scenario_text(rock_mass, "rock.toml");
  const std::atomic<bool> stop = true;
  EXPECT_THROW(take_censuses(scenario, 100, 1.5, 1, &stop), RunError);
}

}  // namespace
}  // namespace keyblock::study
