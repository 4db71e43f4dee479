#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "../fresh_folder.h"
#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario_text.h"
#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

TEST(Warnings, ExamplesHaveNone) {
  for (const auto& entry : std::filesystem::directory_iterator(examples)) {
    if (entry.path().extension() != ".toml") continue;
    std::vector<std::string> warnings;
    build_setup(parse_scenario(entry.path()), 0, &warnings);
    EXPECT_THAT(warnings, IsEmpty()) << entry.path();
  }
}

TEST(Warnings, OfGravityThatDoesNotPullDown) {
  EXPECT_THAT(warnings_of(two_blocks, {"gravity=[0, 9.81]"}),
              UnorderedElementsAre(HasSubstr("pulls upwards")));
  EXPECT_THAT(warnings_of(two_blocks, {"gravity=[9.81, 0]"}),
              UnorderedElementsAre(HasSubstr("pulls sideways")));
  EXPECT_THAT(warnings_of(two_blocks, {"gravity=[4.905, -8.5]"}), IsEmpty());
}

TEST(Warnings, OfALooseEquilibrium) {
  const auto warned = [](double tolerance) {
    return warnings_of(
        two_blocks,
        {fmt::format("stage=[{{ name = \"s\", kind = \"settle\", tolerance = {} }}]", tolerance)});
  };
  EXPECT_THAT(warned(0.05), UnorderedElementsAre(HasSubstr("stage.s.tolerance = 0.05")));
  EXPECT_THAT(warned(1e-3), IsEmpty());
}

TEST(Warnings, OfARuleThatMakesEnergy) {
  EXPECT_THAT(warnings_of(two_blocks, {"solver.integrator=\"average-acceleration\""}),
              UnorderedElementsAre(HasSubstr("makes energy wherever joints slide")));
}

TEST(Warnings, OfResidualStrengthOfWhichNothingFalls) {
  EXPECT_THAT(warnings_of(two_blocks, {"joints.weakening_slip=0.01"}),
              UnorderedElementsAre(HasSubstr("joints: nothing falls to residual strength")));
  EXPECT_THAT(warnings_of(two_blocks, {"joints.weakening_slip=0.01", "joints.residual_friction=20"}),
              IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {"joints.weakening_slip=0.01", "joints.cohesion=5e3"}), IsEmpty());
}

TEST(Warnings, OfCohesionThatInheritsAnotherResidual) {
  const std::vector<std::string> inherits{"joints.cohesion=3e3", "joints.residual_cohesion=3e3",
                                          "joint_set.bedding.cohesion=1.2e4"};
  EXPECT_THAT(
      warnings_of(runnable_domain, inherits),
      Contains(HasSubstr("joint_set.bedding: cohesion 12000 has the residual_cohesion of [joints], 3000;")));
  EXPECT_THAT(warnings_of(runnable_domain,
                          {inherits[0], inherits[1], inherits[2], "joint_set.bedding.residual_cohesion=0"}),
              Not(Contains(HasSubstr("has the residual_cohesion"))));
}

TEST(Warnings, OfAWeakeningSlipInMillimetres) {
  EXPECT_THAT(warnings_of(two_blocks, {"joints.weakening_slip=5", "joints.residual_friction=20"}),
              UnorderedElementsAre(HasSubstr("joints.weakening_slip")));
  EXPECT_THAT(warnings_of(two_blocks, {"joints.weakening_slip=0", "joints.residual_friction=20"}), IsEmpty());
}

// Bonds break one after another, as a zip does.
TEST(Warnings, OfAFactorOfSafetyOfCohesionThatIsLost) {
  const std::vector<std::string> reduced{"joints.strength_factor=1.2", "joints.cohesion=5e3"};
  EXPECT_THAT(warnings_of(two_blocks, reduced),
              UnorderedElementsAre(HasSubstr("residual_cohesion = 5000 keeps it")));
  EXPECT_THAT(warnings_of(two_blocks, {reduced[0], reduced[1], "joints.residual_cohesion=5e3"}), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {reduced[1]}), IsEmpty());
}

TEST(Warnings, OfPlaneStressWithAnOpening) {
  const std::vector<std::string> none{"accept_warnings=['lost-joints']", "rock.order=2"};
  EXPECT_THAT(warnings_of(runnable_domain, none),
              UnorderedElementsAre(
                  HasSubstr("rock.state: plane stress, the default, with an excavation is a thin slab")));
  EXPECT_THAT(warnings_of(runnable_domain, {none[0], none[1], "rock.state=plane-stress"}),
              UnorderedElementsAre(HasSubstr("rock.state (--set): plane stress with an excavation")));
  EXPECT_THAT(warnings_of(runnable_domain, {none[0], none[1], "rock.state=plane-strain"}), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks), IsEmpty());
}

TEST(Warnings, OfStressAtAFreeBoundary) {
  const std::vector<std::string> free{"domain.boundary=free", "in_situ.syy=-1e6"};
  EXPECT_THAT(warnings_of(runnable_domain, free),
              UnorderedElementsAre(HasSubstr("nothing holds the stress")));
  EXPECT_THAT(warnings_of(runnable_domain,
                          {free[0], free[1],
                           "accept_warnings=['plane-stress', 'order-1', 'free-boundary', 'lost-joints']"}),
              UnorderedElementsAre());
  EXPECT_THAT(warnings_of(runnable_domain, {free[0]}), IsEmpty());
  EXPECT_THAT(warnings_of(runnable_domain, {free[1]}), IsEmpty());
}

TEST(Warnings, ThatAreAcceptedAreNamed) {
  EXPECT_THAT(
      mistakes(two_blocks, {"accept_warnings=['plane-stres']"}),
      HasSubstr(
          "accept_warnings[0]: found the string \"plane-stres\"; expected \"plane-stress\", \"order-1\", "
          "\"free-boundary\", \"step\", \"damping\", \"closed-box\", \"closed-ground\", \"late-falls\", "
          "\"lost-joints\", \"loads\", \"scale\", \"window\", \"azimuth\", \"direction\" or \"skipped\"; did "
          "you mean "
          "'plane-stress'?"));
  EXPECT_THAT(mistakes(two_blocks, {"accept_warnings='step'"}), HasSubstr("write [\"step\"]"));
}

// 30 % at 1 Hz in proportion to stiffness is critical at 3.3 Hz.
TEST(Warnings, OfDampingBeyondCritical) {
  const auto warned = [](const std::string& damping, std::vector<std::string> more = {}) {
    more.push_back("solver.damping={" + damping + "}");
    return warnings_of(two_blocks, more);
  };
  EXPECT_THAT(warned("ratio=0.3, frequency=1"),
              UnorderedElementsAre(
                  HasSubstr("solver.damping (--set): a ratio of 0.3 at 1 Hz is more than critical above "
                            "3.33 Hz, 3 times at 10 Hz; what moves there")));
  EXPECT_THAT(warned("ratio=0.09, frequency=1"), IsEmpty());
  EXPECT_THAT(warned("ratio=0.3, frequency=1", {"accept_warnings=['damping']"}), IsEmpty());
  EXPECT_THAT(warned("ratio=0.3, frequency=1", {"stage.quiet={name='quiet', kind='settle'}"}), IsEmpty());
  EXPECT_THAT(warned("ratio=0.9, frequency=3, kind='mass', force=true"),
              UnorderedElementsAre(HasSubstr("more than critical below 2.7 Hz, 2.7 times at 1 Hz")));
  EXPECT_THAT(warned("ratio=0.3, frequency=3, kind='rayleigh', force=true"), IsEmpty());
}

// Blocks of half a metre around an opening of six metres, or of one.
TEST(Warnings, OfBlocksOfOrder1AroundAnOpening) {
  const std::vector<std::string> near{"accept_warnings=['plane-stress', 'lost-joints']"};
  const auto of_order =
      HasSubstr("% of the rock within one width of excavation.tunnel is in blocks of order 1 larger than");
  const auto warned = [&](std::vector<std::string> overrides) {
    overrides.push_back(near[0]);
    return warnings_of(runnable_domain, overrides);
  };
  EXPECT_THAT(warned({}), UnorderedElementsAre(of_order));
  EXPECT_THAT(warned({"rock.order=2"}), IsEmpty());
  EXPECT_THAT(warned({"rock.order=auto"}), IsEmpty());
  EXPECT_THAT(warned({"stage.settled.excavate=[]"}),
              UnorderedElementsAre(HasSubstr("no stage excavates it")));
  const char* const two_sets =
      R"(joint_set=[{name='a', dip=20, dip_direction=90, spacing=0.5, length=60, gap=0}, {name='b', dip=70, dip_direction=270, spacing=0.5, length=60, gap=0}])";
  const std::vector<std::string> wide{"domain.x=[-10, 10]",           "domain.y=[-10, 10]",
                                      "excavation.tunnel.diameter=6", "joint_set.bedding.gap=0",
                                      "joint_set.bedding.length=40",  two_sets};
  EXPECT_THAT(warned({wide[0], wide[1], wide[2], wide[5]}), IsEmpty());
  const auto stiff = HasSubstr("the joints are 5 times as stiff as the default, 2e+10 Pa/m");
  EXPECT_THAT(warned({wide[0], wide[1], wide[2], wide[5], "joints.normal_stiffness=1e11"}),
              UnorderedElementsAre(stiff));
  EXPECT_THAT(warned({wide[0], wide[1], wide[2], wide[5], "solver.penalty=100"}),
              UnorderedElementsAre(stiff));
  EXPECT_THAT(warned({wide[0], wide[1], wide[2], wide[5], "joints.normal_stiffness=2e10"}), IsEmpty());
  // Closure is a lower bound whether or not that is accepted.
  EXPECT_TRUE(build_setup(parse(runnable_domain), 0).closure_is_lower_bound);
  EXPECT_FALSE(build_setup(parse(runnable_domain, {"rock.order=2"}), 0).closure_is_lower_bound);
  EXPECT_FALSE(build_setup(parse(two_blocks), 0).closure_is_lower_bound);
}

TEST(Warnings, AreInTheSetupOfARun) {
  EXPECT_THAT(build_setup(parse(two_blocks, {"rock.density=2.6"}), 0).warnings,
              UnorderedElementsAre(HasSubstr("rock.density = 2.6")));
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

TEST(Warnings, OfStepsThatAreLongForTheMotion) {
  const std::string shaken = two_blocks + shaking;  // 1 Hz
  EXPECT_THAT(warnings_of(shaken, {"time.step=0.05"}), IsEmpty());
  EXPECT_THAT(warnings_of(shaken, {"time.step=0.1"}),
              UnorderedElementsAre(
                  HasSubstr("time.step = 0.1 s (--set): motion.sine swings with a period of about 1 s, "
                            "which is 10 steps; usual is at least 20 steps, 0.05 s")));
  EXPECT_THAT(warnings_of(shaken, {"time.step=0.1", "accept_warnings=['step']"}), IsEmpty());
  // A ramp does not swing.
  EXPECT_THAT(warnings_of(shaken, {"motion.sine.x=[[0, 0], [0.001, 1], [5, 1]]"}), IsEmpty());
  // A record has a step of its own.
  const FreshFolder own;
  const std::filesystem::path record = own / "slow.csv";
  std::ofstream file(record);
  file << "time s,acceleration m/s2\n";
  for (int k = 0; k <= 400; ++k) file << 0.01 * k << "," << std::sin(k * 0.01) << "\n";
  file.close();
  const std::string recorded = "section.azimuth = 90\n" + two_blocks + R"(
[[motion]]
name = "slow"
components = [{ azimuth = 90, file = ")" +
                               record.string() + R"(" }]
[[stage]]
name = "shaken"
kind = "shake"
motion = "slow"
)";
  EXPECT_THAT(warnings_of(recorded), IsEmpty());
  EXPECT_THAT(warnings_of(recorded, {"time.step=0.02"}),
              UnorderedElementsAre(
                  HasSubstr("longer than the step of the record of motion.slow, 0.01 s; what is faster "
                            "than 0.04 s is lost")));
}

TEST(Warnings, OfPeaksThatNoEarthquakeHas) {
  const std::string shaken = two_blocks + shaking;
  EXPECT_THAT(warnings_of(shaken, {"stage.shaken.scale=25"}), IsEmpty());
  EXPECT_THAT(warnings_of(shaken, {"motion.sine.x.amplitude=35"}),
              UnorderedElementsAre(
                  HasSubstr("stage.shaken: the peak acceleration of motion.sine is 35 m/s2, 3.57 g, with "
                            "scale = 1; usual is 0.0001 to 3 g; is the record in cm/s2")));
  EXPECT_THAT(warnings_of(shaken, {"stage.shaken.scale=35"}),
              UnorderedElementsAre(
                  HasSubstr("stage.shaken.scale (--set): 35 is a factor, and makes 3.57 g of 0.102 g in "
                            "the section; was it in per cent? That is 0.35")));
  EXPECT_THAT(warnings_of(shaken, {"stage.shaken.scale=1e-4"}),
              UnorderedElementsAre(HasSubstr("is the record in g"),
                                   HasSubstr("stage.shaken.scale = 0.0001 (--set): usual is 0.01 to 100")));
  EXPECT_THAT(warnings_of(shaken, {"stage.shaken.scale=0"}), IsEmpty());
  EXPECT_THAT(warnings_of("units = \"other\"\n" + shaken, {"stage.shaken.scale=35"}), IsEmpty());
}

// What comes down into an opening lies on its floor.
TEST(Warnings, OfAFallThatNothingCanMake) {
  EXPECT_THAT(
      warnings_of(runnable_domain, {"damage.fall_distance=1.5"}),
      Contains(HasSubstr("openings are 1 m high, and what falls into them does not count as fallen")));
  EXPECT_THAT(warnings_of(runnable_domain, {"damage.fall_distance=0.5"}),
              Not(Contains(HasSubstr("openings are"))));
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
  const FreshFolder own;
  const std::filesystem::path map = own / "elsewhere.csv";
  std::ofstream(map) << "trace,x,y\n1,100,100\n1,101,102\n";
  const std::string text =
      runnable_domain + "[[trace_map]]\nname = \"map\"\nfile = \"" + map.string() + "\"\n";
  EXPECT_THAT(warnings_of(text),
              UnorderedElementsAre(
                  HasSubstr("no trace meets the domain; the map reaches from [100, 100] to [101, 102]")));
  std::ofstream(map) << "trace,x,y\n1,1,1\n1,101,102\n";
  EXPECT_THAT(warnings_of(text, {"accept_warnings=['plane-stress', 'order-1']"}),
              testing::Contains(HasSubstr("trace_map.map: 19 % of its")));
  EXPECT_THAT(warnings_of(text, {"accept_warnings=['plane-stress', 'order-1', 'lost-joints']"}), IsEmpty());
}

TEST(Warnings, OfTracesThatEndShortOfOthers) {
  const std::string map = "[[trace_map]]\nname = \"map\"\nlines = [[[0, 2], [2.9, 2]], [[3, 0], [3, 4]]]\n";
  const std::string jointed = "[domain]\nx = [0, 4]\ny = [0, 4]\n" + map +
                              two_blocks.substr(0, two_blocks.find("[[block]]")) +
                              two_blocks.substr(two_blocks.find("[[stage]]"));
  EXPECT_THAT(
      warnings_of(jointed),
      UnorderedElementsAre(AllOf(HasSubstr("is 0.1 m short of another trace: [cutting] snapping = 0.11"))));
  EXPECT_THAT(warnings_of(jointed, {"cutting.snapping=0.11"}), IsEmpty());
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

TEST(Warnings, OfForcesThatAreNotReleased) {
  const std::string opened = jointed_domain + R"(
[in_situ]
depth = 50.0
k0 = 1.0

[[excavation]]
name = "tunnel"
shape = "circle"
center = [2.0, 1.5]
diameter = 1.0

[time]
step = 0.002

[[stage]]
name = "open"
kind = "settle"
excavate = ["tunnel"]
release = 0.4
)";
  const auto told =
      HasSubstr("0.6 of the forces of the rock of 'tunnel' are not released and still hold its wall");
  EXPECT_THAT(warnings_of(opened),
              UnorderedElementsAre(testing::AllOf(HasSubstr("stage.open: at the end of the run"), told)));
  const std::string rest = "[[stage]]\nname = \"rest\"\nkind = \"rest\"\nduration = 1.0\n";
  EXPECT_THAT(warnings_of(opened + rest),
              UnorderedElementsAre(testing::AllOf(HasSubstr("stage.rest: in a dynamic stage"), told)));
  EXPECT_THAT(warnings_of(opened + "[[stage]]\nname = \"all\"\nkind = \"settle\"\nrelease = 1.0\n" + rest),
              IsEmpty());
}

}  // namespace
}  // namespace keyblock::scenario
