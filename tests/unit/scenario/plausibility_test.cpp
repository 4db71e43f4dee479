#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::string> warnings_of(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> warnings;
  build_setup(parse(text, overrides), 0, &warnings);
  return warnings;
}

TEST(Warnings, TheTunnelHasNone) {
  EXPECT_THAT(plausibility_warnings(parse_scenario(examples / "01-tunnel.toml")), IsEmpty());
  EXPECT_THAT(plausibility_warnings(parse_scenario(examples / "02-tunnel-in-situ.toml")), IsEmpty());
}

TEST(Warnings, OfStress) {
  EXPECT_THAT(warnings_of(runnable_domain, {"in_situ.depth=30", "in_situ.k0=0.3"}),
              UnorderedElementsAre(HasSubstr("3 K0 < 1")));
  EXPECT_THAT(warnings_of(two_blocks, {"in_situ.syy=1e6"}), UnorderedElementsAre(HasSubstr("tension")));
}

TEST(Warnings, OfStressByDepthWhereDensitiesDiffer) {
  const std::vector<std::string> by_depth{"in_situ.depth=30", "in_situ.k0=0.5"};
  const std::string layered =
      runnable_domain + "[[region]]\nouter = [[0, 0], [4, 0], [4, 1], [0, 1]]\ndensity = 1200.0\n";
  EXPECT_THAT(warnings_of(layered, by_depth),
              UnorderedElementsAre(HasSubstr("in_situ.depth: counts on the density of [rock], 2600 kg/m3, "
                                             "everywhere, but region[0] has 1200 kg/m3")));
  EXPECT_THAT(warnings_of(layered), IsEmpty());
  EXPECT_THAT(warnings_of(layered, {"in_situ.syy=-1e6"}), IsEmpty());
  EXPECT_THAT(warnings_of(layered, {by_depth[0], by_depth[1], "region.0.density=2600"}), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks,
                          {by_depth[0], by_depth[1], "block.top.density=2000", "block.base.density=9000"}),
              testing::Contains(HasSubstr("block.top has 2000 kg/m3")).Times(1));
}

const std::string shaking = R"(
[[motion]]
name = "sine"
x = { amplitude = 1.0, frequency = 1.0, cycles = 1 }
[[stage]]
name = "shaken"
kind = "shake"
motion = "sine"
)";

TEST(Warnings, OfExcavations) {
  EXPECT_THAT(warnings_of(runnable_domain, {"stage.settled.excavate=[]"}),
              UnorderedElementsAre(HasSubstr("excavation.tunnel: no stage excavates it")));
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.center=[4, 2]"}),
              UnorderedElementsAre(HasSubstr("reaches beyond the domain")));
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.center=[14, 2]"}),
              UnorderedElementsAre(HasSubstr("reaches beyond the domain"), HasSubstr("holds no block")));
}

TEST(Warnings, OfStages) {
  const std::string shaken = runnable_domain + shaking;
  EXPECT_THAT(warnings_of(shaken), UnorderedElementsAre(HasSubstr("comes down during the shaking")));
  EXPECT_THAT(warnings_of(shaken, {"stage.settled.excavate=[]", "stage.shaken.excavate=['tunnel']"}),
              UnorderedElementsAre(HasSubstr("shakes before the rock has settled")));
  EXPECT_THAT(plausibility_warnings(parse(jointed_domain)), UnorderedElementsAre(HasSubstr("no [[stage]]")));
}

TEST(Warnings, OfShakingRockThatNeverSettled) {
  const std::string shaken = jointed_domain + R"(
[time]
step = 0.01
[[excavation]]
name = "tunnel"
shape = "circle"
center = [2, 1.5]
diameter = 1
)" + shaking;
  EXPECT_THAT(warnings_of(shaken, {"in_situ.depth=30", "in_situ.k0=0.5"}),
              UnorderedElementsAre(HasSubstr("no stage excavates it"),
                                   HasSubstr("stage.shaken: shakes before the rock has settled")));
}

TEST(Warnings, OfVelocitiesThatSettlingTakesAway) {
  const std::string settled = two_blocks + "[[stage]]\nname = \"s\"\nkind = \"settle\"\n";
  EXPECT_THAT(warnings_of(settled, {"block.top.velocity=[1, 0]"}), IsEmpty());
  const std::vector<std::string> first{"stage=[{name=\"s\", kind=\"settle\"}]", "block.top.spin=2"};
  EXPECT_THAT(warnings_of(two_blocks, first), UnorderedElementsAre(HasSubstr("block.top.spin: is lost")));
}

TEST(Warnings, OfFixedBlocksThatMoveDifferently) {
  const std::string motion = "motion={x=[[0, 0], [1, 0.1]]}";
  EXPECT_THAT(warnings_of(two_blocks, {"block.base." + motion}), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {"block.base." + motion, "block.top.fixed=true"}),
              UnorderedElementsAre(HasSubstr("fixed blocks move differently; damage is counted in space")));
  EXPECT_THAT(
      warnings_of(two_blocks, {"block.base." + motion, "block.top.fixed=true", "block.top." + motion}),
      IsEmpty());
}

TEST(Warnings, OfStagesThatAreNoWholeSteps) {
  EXPECT_THAT(warnings_of(two_blocks, {"time.step=0.07", "stage.quiet.duration=0.1"}),
              UnorderedElementsAre(HasSubstr("the stage takes 1 step, 0.07 s")));
  EXPECT_THAT(warnings_of(two_blocks, {"time.step=0.06", "stage.quiet.duration=0.1"}),
              UnorderedElementsAre(HasSubstr("the stage takes 2 steps, 0.12 s")));
  EXPECT_THAT(warnings_of(two_blocks, {"time.step=0.001", "stage.quiet.duration=0.3"}), IsEmpty());
}

TEST(Warnings, OfRockThatIsNotThere) {
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.diameter=100"}),
              testing::Contains(HasSubstr("excavation.tunnel: holds every block")));
}

TEST(Warnings, OfTraceMapsElsewhere) {
  const std::filesystem::path map = std::filesystem::path(testing::TempDir()) / "elsewhere.csv";
  std::ofstream(map) << "trace,x,y\n1,100,100\n1,101,102\n";
  const std::string text =
      runnable_domain + "[[trace_map]]\nname = \"map\"\nfile = \"" + map.string() + "\"\n";
  EXPECT_THAT(warnings_of(text),
              UnorderedElementsAre(
                  HasSubstr("no trace meets the domain; the map reaches from [100, 100] to [101, 102]")));
  std::ofstream(map) << "trace,x,y\n1,1,1\n1,101,102\n";
  EXPECT_THAT(warnings_of(text), IsEmpty());
}

TEST(Warnings, OfBlocksThatOverlap) {
  EXPECT_THAT(warnings_of(two_blocks), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {"block.top.outer=[[1, 0.9], [3, 0.9], [3, 2], [1, 2]]"}),
              UnorderedElementsAre(HasSubstr("block.base and block.top overlap by 0.1 m at")));
}

TEST(Warnings, OfHistoriesThatEndAsTheirRockIsExcavated) {
  const std::string watched = runnable_domain + "[[history]]\nname = \"h\"\npoint = [2.0, 1.5]\n";
  EXPECT_THAT(
      warnings_of(watched),
      UnorderedElementsAre("history.h.point: lies in rock that the stage 'settled' excavates; the history "
                           "ends there"));
  EXPECT_THAT(warnings_of(watched, {"history.h.point=[2.0, 2.0]"}), IsEmpty());  // in the wall
}

TEST(Warnings, OfDistributionsThatAreCutOff) {
  EXPECT_THAT(
      warnings_of(runnable_domain, {"joint_set.bedding.gap={mean=0.5, std=0.5, distribution=\"normal\"}"}),
      UnorderedElementsAre(HasSubstr("joint_set.bedding.gap: cut off at zero")));
}

TEST(Warnings, OfTensionThatHoldsNothing) {
  EXPECT_THAT(warnings_of(two_blocks, {"joints.tension=1e6"}),
              UnorderedElementsAre(HasSubstr("joints: tension without cohesion holds nothing")));
  EXPECT_THAT(warnings_of(two_blocks, {"joints.tension=1e6", "joints.cohesion=1e6", "joints.friction=44"}),
              IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {"joints.tension=1e6", "joints.cohesion=1e6", "joints.friction=46"}),
              UnorderedElementsAre(
                  HasSubstr("pulled by cohesion / tan(friction), 9.657e+05, before its tension of 1e+06")));
  const auto of_set = HasSubstr("joint_set.bedding: tension without cohesion");
  EXPECT_THAT(warnings_of(runnable_domain, {"joint_set.bedding.tension=1e6"}), UnorderedElementsAre(of_set));
  EXPECT_THAT(warnings_of(runnable_domain, {"joint_set.bedding.tension=1e6", "joints.cohesion=1e6"}),
              IsEmpty());
  // A set of another friction says nothing anew of what it has from [joints].
  EXPECT_THAT(warnings_of(runnable_domain, {"joints.tension=1e6", "joint_set.bedding.friction=20"}),
              UnorderedElementsAre(HasSubstr("joints: tension without cohesion")));
  EXPECT_THAT(warnings_of(runnable_domain,
                          {"joints.tension=1e6", "joints.cohesion=1e6", "joint_set.bedding.cohesion=0"}),
              UnorderedElementsAre(of_set));
}

TEST(Warnings, OfAnOrderThatIsNotChosen) {
  EXPECT_THAT(warnings_of(two_blocks, {"auto_order.highest_order=4"}),
              UnorderedElementsAre(HasSubstr("auto_order: is not used")));
  EXPECT_THAT(warnings_of(two_blocks, {"auto_order.highest_order=4", "block.top.order=auto"}), IsEmpty());
}

TEST(Warnings, OfRealizationsThatAreAllTheSame) {
  EXPECT_THAT(study_warnings(parse(two_blocks, {"study.realizations=5"})),
              UnorderedElementsAre(HasSubstr("study.realizations = 5: nothing is random")));
  EXPECT_THAT(study_warnings(parse(two_blocks, {"study.until={measure=\"fallen_blocks\", width=1}"})),
              UnorderedElementsAre(HasSubstr("study.until: nothing is random")));
  EXPECT_THAT(study_warnings(parse(two_blocks, {"study.realizations=1"})), IsEmpty());
  EXPECT_THAT(study_warnings(parse(jointed_domain, {"study.realizations=5"})), IsEmpty());
  EXPECT_THAT(study_warnings(parse(two_blocks)), IsEmpty());
}

}  // namespace
}  // namespace keyblock::scenario
