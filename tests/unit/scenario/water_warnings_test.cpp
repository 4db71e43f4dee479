// What is odd about water, and what a scenario says of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenario/ground_facts.h"
#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

TEST(WaterWarnings, OfATableThatTouchesNothing) {
  EXPECT_THAT(warnings_of(two_blocks, {"water={head=-3}"}),
              UnorderedElementsAre(HasSubstr("water (--set): lies below all of the model")));
  EXPECT_THAT(warnings_of(two_blocks, {"water={table=[[-9, -1], [2, 1.5], [9, -1]]}"}), IsEmpty());
}

TEST(WaterWarnings, OfHeightsAndDensitiesInOtherUnits) {
  EXPECT_THAT(warnings_of(two_blocks, {"water={head=5000}"}),
              UnorderedElementsAre(HasSubstr("stands 5000 m above the base of the model; heights are in m")));
  EXPECT_THAT(warnings_of(two_blocks, {"water={head=5, density=1.0}"}),
              UnorderedElementsAre(HasSubstr("t/m3 or g/cm3")));
}

TEST(WaterWarnings, OfATableThatIsNoWaterAtRest) {
  EXPECT_THAT(warnings_of(two_blocks, {"gravity=[4.905, -8.5]", "water={head=2}"}),
              UnorderedElementsAre(HasSubstr("no water at rest then. One that is has a slope of 0.5771")));
}

TEST(WaterWarnings, OfDrainageThatNobodyAskedFor) {
  EXPECT_THAT(warnings_of(runnable_domain, {"water={head=8}"}),
              Contains(HasSubstr("excavation.tunnel: lies up to")));
  for (const char* said : {"true", "false"})
    EXPECT_THAT(
        warnings_of(runnable_domain, {"water={head=8}", std::string("excavation.tunnel.filled=") + said}),
        Not(Contains(HasSubstr("drained"))));
}

TEST(WaterWarnings, OfKeysWithoutWater) {
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.filled=true"}),
              Contains(HasSubstr("excavation.tunnel.filled: there is no [water]")));
  EXPECT_THAT(warnings_of(runnable_domain, {"joint_set.0.dry=true"}),
              Contains(HasSubstr(".dry: there is no [water]")));
}

// The first one acts until a stage says otherwise.
TEST(WaterWarnings, OfWaterThatNoStageUses) {
  const std::string two = "water=[{name='a', head=2}, {name='b', head=1}]";
  EXPECT_THAT(warnings_of(two_blocks, {two}), UnorderedElementsAre(HasSubstr("no stage uses it")));
  EXPECT_THAT(warnings_of(two_blocks, {two, "stage.quiet.water='b'"}),
              UnorderedElementsAre(HasSubstr("no stage uses it")));
}

TEST(WaterWarnings, OfJointsThatAreAllDry) {
  EXPECT_THAT(
      warnings_of(runnable_domain, {"water={head=8}", "joint_set.0.dry=true"}),
      Contains(HasSubstr("water: all joint sets, trace maps and interfaces are dry; no joint is wet")));
  EXPECT_THAT(warnings_of(runnable_domain, {"water={head=8, sets=['bedding']}", "joint_set.0.dry=true"}),
              Contains(HasSubstr("water.sets: names joints that are dry = true, which holds")));
  EXPECT_THAT(warnings_of(runnable_domain, {"water={head=8}"}), Not(Contains(HasSubstr("dry"))));
}

TEST(Water, IsAmongTheFacts) {
  const Scenario scenario = parse(two_blocks, {"water={table=[[0, 2], [4, 1.5]]}"});
  EXPECT_THAT(ground_facts(scenario), Contains(GroundFact{"water", "table from 1.5 to 2 m, γw 9.81 kN/m³"}));
}

TEST(Water, IsReadAloneOrAsAList) {
  EXPECT_EQ(parse(two_blocks, {"water={head=2}"}).waters.size(), 1);
  const Scenario several =
      parse(two_blocks, {"water=[{name='a', head=2}, {name='b', head=1}]", "stage.quiet.water='b'"});
  EXPECT_EQ(several.waters.size(), 2);
  EXPECT_EQ(several.stages[0].water, 1);
  EXPECT_EQ(parse(two_blocks, {"water={head=2}", "stage.quiet.water='none'"}).stages[0].water, -1);
}

TEST(Water, OfASetIsDryForTheOthers) {
  const Scenario scenario = parse(runnable_domain, {"water={head=8}", "joint_set.0.dry=true"});
  EXPECT_TRUE(build_setup(scenario, 0).waters.at(0).dry_joints.at(0));
}

}  // namespace
}  // namespace keyblock::scenario
