// Rock bridges, as a scenario says them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "guide_snippet.h"
#include "scenario/joint_warnings.h"
#include "scenario/own_joints.h"
#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string bridge = "rock_bridge={friction=45, cohesion=1e6}",
                  dead_ends = "cutting.dead_ends='bridge'";

std::string mistakes_of(const std::vector<std::string>& overrides) {
  try {
    parse(jointed_domain, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(RockBridge, HasItsPlaceAfterTheJointSets) {
  const Scenario scenario = parse(jointed_domain, {bridge, dead_ends});
  EXPECT_THAT(names_of(own_joints(scenario)), ElementsAre("bedding", "rock_bridge"));
}

// Gaps of 0.5 m after traces of 3 m: in a domain without dead ends all that is left are bridges.
TEST(RockBridge, IsCutInGapsAndBeforeDeadEnds) {
  const auto blocks = [](const std::vector<std::string>& overrides) {
    return build_blocks(parse(jointed_domain, overrides), 0).system;
  };
  const cutting::BlockSystem without = blocks({});
  EXPECT_GT(without.statistics.removed_length, 0.0);
  for (const std::string& how : {dead_ends, std::string("joint_set.bedding.gap_bonds=true")}) {
    const cutting::BlockSystem with = blocks({bridge, how});
    EXPECT_GT(with.statistics.bridge_length, 1.0) << how;
    EXPECT_NEAR(with.statistics.removed_length, 0.0, 1e-6) << how;
    EXPECT_GT(with.blocks.size(), without.blocks.size()) << how;
    EXPECT_THAT(joints_in_model(parse(jointed_domain, {bridge, how}), with),
                HasSubstr("m of rock bridges on bedding"));
  }
}

TEST(RockBridge, NeedsAStrength) {
  EXPECT_THAT(mistakes_of({dead_ends}),
              HasSubstr("cutting.dead_ends: found \"bridge\" without [rock_bridge]"));
  EXPECT_THAT(mistakes_of({"joint_set.bedding.gap_bonds=true"}),
              HasSubstr("gap_bonds without [rock_bridge]"));
  EXPECT_THAT(mistakes_of({bridge, dead_ends, "joint_set.bedding.name='rock_bridge'"}),
              HasSubstr("a name of its own"));
}

TEST(RockBridge, ThatNothingHasIsOdd) {
  EXPECT_THAT(warnings_of(runnable_domain, {bridge}),
              Contains(HasSubstr("rock_bridge (--set): no joint has bridges")));
  EXPECT_THAT(warnings_of(runnable_domain, {bridge, dead_ends}),
              Not(Contains(HasSubstr("no joint has bridges"))));
}

TEST(RockBridge, OfTheGuide) {
  const Scenario scenario = parse(jointed_domain + snippet("[rock_bridge]"));
  EXPECT_TRUE(scenario.cutting.bridges_dead_ends);
  EXPECT_EQ(scenario.rock_bridge->joints.residual_friction, 30.0);
}

}  // namespace
}  // namespace keyblock::scenario
