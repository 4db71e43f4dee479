#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "loading/motion_measures.h"
#include "scenario/shaking_checks.h"
#include "scenario/usual.h"
#include "scenario_text.h"
#include "warnings_of.h"

namespace keyblock::scenario {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// 0.102 g, a sine of 2 Hz: its velocity from rest is A/π f (1 - cos)/2, at most A/(π f).
const std::string shaken_blocks = two_blocks + R"(
[[motion]]
name = "m"
x = { amplitude = 1.0, frequency = 2.0, cycles = 4 }
[[stage]]
name = "shaken"
kind = "shake"
motion = "m"
)";

double peak_of(const std::vector<std::string>& overrides) {
  std::vector<std::string> warnings;
  const auto motions = read_motions(parse(shaken_blocks, overrides), warnings);
  return loading::measure_along({1.0, 0.0}, motions.front(), 1.0, motions.front().duration()).peak;
}

TEST(OddInput, TargetsOfMotions) {
  EXPECT_NEAR(peak_of({"motion.m.pga=3.43"}), 3.43, 1e-12);
  // A/(π f) of 1 m/s² at 2 Hz is 0.159 m/s.
  EXPECT_NEAR(peak_of({"motion.m.pgv=0.3"}), 0.3 * std::numbers::pi * 2.0, 1e-4);
  EXPECT_THAT(
      mistakes(shaken_blocks, {"motion.m.pga=3.43", "stage.shaken.scale=2"}),
      HasSubstr("stage.shaken.scale: found a factor on 'm', which has pga = 3.43; expected one of the two: "
                "scale, or pga of the motion"));
  EXPECT_THAT(mistakes(shaken_blocks, {"motion.m.pga=3.43", "motion.m.pgv=2"}),
              HasSubstr("it only with no pga"));
  EXPECT_THAT(warnings_of(shaken_blocks, {"motion.m.pga=0.35"}), ElementsAre(HasSubstr("was it in g?")));
  // Vertical shaking alone has no horizontal peak.
  EXPECT_THAT(
      refusal(parse(shaken_blocks, {"motion.m={name='m', pga=1, y={amplitude=1, frequency=2, cycles=1}}"})),
      HasSubstr("motion.m.pga: found a target for a motion that does not shake along the section"));
}

TEST(OddInput, AFactorThatSeemsToBeAPeak) {
  EXPECT_THAT(
      warnings_of(shaken_blocks, {"stage.shaken.scale=0.35"}),
      ElementsAre(HasSubstr("stage.shaken.scale (--set): 0.35 is a factor, and 0.102 g of the sine in the "
                            "section become 0.036 g; for a peak of 0.35 g take pga = 3.432 (m/s2) of the "
                            "motion, or scale = 3.43")));
  EXPECT_THAT(warnings_of(shaken_blocks, {"stage.shaken.scale=0.35", "accept_warnings=['scale']"}),
              IsEmpty());
  EXPECT_THAT(warnings_of(shaken_blocks, {"stage.shaken.scale=3"}), IsEmpty());
  // Half of a strong record is meant; a sine has an amplitude of its own.
  EXPECT_THAT(warnings_of(shaken_blocks,
                          {"stage.shaken.scale=0.5", "motion.m.x=[[0, 0], [0.1, 5], [0.3, -5], [0.4, 0]]"}),
              IsEmpty());
  EXPECT_THAT(warnings_of(shaken_blocks, {"stage.shaken.scale=0.5", "motion.m.x.amplitude=5"}),
              ElementsAre(HasSubstr("0.51 g of the sine in the section become 0.25 g")));
}

TEST(OddInput, AnAmplitudeThatSeemsToBeInG) {
  EXPECT_THAT(
      warnings_of(shaken_blocks, {"motion.m.x.amplitude=0.3"}),
      ElementsAre(HasSubstr("motion.m (line 26): shakes by at most 0.3 m/s2 in the stage 'shaken'; usual "
                            "is 0.5 to 30 m/s2; was it in g? That is 2.943 m/s2")));
  // A Ricker wavelet, as rows.
  EXPECT_THAT(
      warnings_of(shaken_blocks, {"motion.m.x=[[0, 0], [0.1, -0.13], [0.2, 0.3], [0.3, -0.13], [0.4, 0]]"}),
      ElementsAre(HasSubstr("was it in g? That is 2.943 m/s2")));
  for (const char* meant :
       {"accept_warnings=['scale']", "stage.shaken.scale=9.81", "motion.m.pga=3", "units=other"})
    EXPECT_THAT(warnings_of(shaken_blocks, {"motion.m.x.amplitude=0.3", meant}), IsEmpty()) << meant;
  EXPECT_THAT(warnings_of(shaken_blocks, {"motion.m.x.amplitude=0.6"}), IsEmpty());
  EXPECT_THAT(warnings_of(shaken_blocks, {"motion.m.x.amplitude=0.1"}), IsEmpty()) << "as for waves";
}

// The record of example 01 has components at 0 and 90 degrees.
TEST(OddInput, ASectionNormalToItsRecord) {
  const std::string across = two_blocks + fmt::format(R"([section]
azimuth = 90.0
[[motion]]
name = "m"
components = [{{ file = "{}" }}]
[[stage]]
name = "shaken"
kind = "shake"
motion = "m"
)",
                                                      (examples / "motions/0111a.smc").string());
  const auto along = warnings_of(across, {"section.azimuth=0"}), normal = warnings_of(across);
  EXPECT_THAT(along, Not(Contains(HasSubstr("azimuth"))));
  EXPECT_THAT(normal,
              Contains(AllOf(HasSubstr("stage.shaken: the peak acceleration of motion.m is "),
                             HasSubstr("is section.azimuth = 90 (line 26) normal to the motion, or is the "
                                       "record in g, and was read as m/s2 or cm/s2?"))));
  EXPECT_THAT(normal, Not(Contains(HasSubstr("the only horizontal component")))) << "told once";
}

TEST(OddInput, AUnitIsHintedOnce) {
  const auto load = [](const char* traction) {
    return two_blocks + "[[load]]\nblock = \"top\"\nfrom = [3, 1]\nto = [3, 2]\ntraction = " + traction +
           "\n";
  };
  EXPECT_THAT(warnings_of(load("[-0.03, 0]")), ElementsAre(HasSubstr("was it in MPa?")));
  EXPECT_THAT(warnings_of(load("[-30, 0]")), ElementsAre(HasSubstr("was it in kPa?")));
  EXPECT_THAT(
      warnings_of(shaken_blocks, {"motion.m.pgv=30"}),
      ElementsAre(HasSubstr("motion.m.pgv = 30 m/s (--set): usual is 0.003 to 5 m/s; was it in cm/s?")));
  EXPECT_THAT(warnings_of(shaken_blocks, {"motion.m.pga=300"}), ElementsAre(HasSubstr("was it in cm/s2?")));
  EXPECT_THAT(warnings_of(shaken_blocks, {"motion.m.x.amplitude=300"}),
              ElementsAre(HasSubstr("was it in cm/s2?")));
  EXPECT_THAT(warnings_of(shaken_blocks, {"stage.shaken.scale=300"}),
              ElementsAre(HasSubstr("was it in percent?")));
}

TEST(OddInput, StrengthsAboveThoseOfRock) {
  for (const char* key : {"joints.cohesion", "joints.tension"}) {
    const std::string set = key, cohesive = "joints.cohesion=1e12";
    EXPECT_THAT(warnings_of(two_blocks, {cohesive, set + "=1e8"}),
                Contains(HasSubstr(
                    set + " = 1e+08 Pa (--set): usual is at most 5e+07 Pa, or 1e+09 Pa and more for what "
                          "never breaks; was it in mPa? That is 1e+05 Pa")));
    EXPECT_THAT(warnings_of(two_blocks, {cohesive, set + "=1e9"}), IsEmpty()) << "it never breaks";
    EXPECT_THAT(warnings_of(two_blocks, {cohesive, set + "=2e7"}), IsEmpty());
  }
}

TEST(OddInput, FactorsOnLoads) {
  const std::string loaded =
      two_blocks + "[[load]]\nblock = \"top\"\nfrom = [3, 1]\nto = [3, 2]\ntraction = [-30e3, 0]\n";
  EXPECT_THAT(
      warnings_of(loaded, {"load_factor=100"}),
      ElementsAre(HasSubstr("load_factor = 100 (--set): usual is 0.02 to 20; was it in percent? That is 1")));
  EXPECT_THAT(warnings_of(loaded, {"load_factor=5"}), IsEmpty());
}

TEST(OddInput, LimitsOfDamageAndTheSizeOfBlocks) {
  // Of 1.4 and 2 m.
  const auto warned = [](const char* limit) { return warnings_of(two_blocks, {limit}); };
  EXPECT_THAT(
      warned("damage.slip=2"),
      ElementsAre(HasSubstr("damage.slip = 2 m (--set): blocks are 1.7 m, and nothing counts before it has "
                            "left its place; was it in cm? That is 0.02 m")));
  EXPECT_THAT(warned("damage.loosened_distance=5"), ElementsAre(HasSubstr("was it in cm? That is 0.05 m")));
  EXPECT_THAT(warned("damage.opening=2e-6"),
              ElementsAre(HasSubstr("all count that bend or settle; usual is at least")));
  EXPECT_THAT(warned("damage.slip=20"), ElementsAre(HasSubstr("was it in cm?"))) << "told once";
  for (const char* usual : {"damage.slip=0.002", "damage.loosened_distance=0.1", "damage.opening=5e-5"})
    EXPECT_THAT(warned(usual), IsEmpty()) << usual;
}

/// Ground that falls to the left: a block on a base, that a step of the ground holds.
const std::string slope_to_the_left = R"([rock]
density = 2600.0
young = 1e9
poisson = 0.2
[joints]
friction = 30.0
[time]
step = 0.01
[[block]]
name = "base"
outer = [[0, 0], [10, 0], [10, 5], [6, 5], [2, 1], [0, 1]]
fixed = true
[[block]]
name = "top"
outer = [[3, 2], [5, 4], [4, 5], [2.5, 3]]
[[stage]]
name = "quake"
kind = "settle"
)";

TEST(OddInput, WhatPushesIntoTheSlope) {
  EXPECT_THAT(warnings_of(slope_to_the_left, {"stage.quake.k_h=0.15"}),
              ElementsAre(HasSubstr(
                  "stage.quake.k_h = 0.15 (--set): pushes to the right, into the slope, which falls "
                  "to the left; -0.15 pushes out of it")));
  EXPECT_THAT(warnings_of(slope_to_the_left, {"stage.quake.k_h=-0.15"}), IsEmpty());
  EXPECT_THAT(warnings_of(slope_to_the_left, {"tilt=-5"}),
              ElementsAre(HasSubstr("tilt = -5 (--set): pushes to the right, into the slope")));
  EXPECT_THAT(warnings_of(slope_to_the_left, {"tilt=5"}), IsEmpty());
  EXPECT_THAT(warnings_of(slope_to_the_left, {"tilt=-5", "accept_warnings=['direction']"}), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {"tilt=-5"}), IsEmpty()) << "no slope";
}

std::vector<std::string> of_study(const std::string& study) {
  return study_warnings(parse(shaken_blocks + study));
}

TEST(OddInput, LevelsOfAStudy) {
  const std::string axis = "[[study.vary]]\nkey = \"stage.shaken.scale\"\nvalues = ";
  EXPECT_THAT(of_study(axis + "[0.1, 0.2, 0.35]\n"),
              ElementsAre(HasSubstr("study.vary: stage.shaken.scale: 0.2 is a")));
  EXPECT_THAT(of_study(axis + "[10, 20, 50]\n"), ElementsAre(HasSubstr("was it in per cent? That is 0.5")));
  EXPECT_THAT(of_study(axis + "[0.5, 1, 2, 4]\n"), IsEmpty()) << "factors";
  EXPECT_THAT(of_study("[[study.level]]\nname = \"a\"\nmeasure = \"opening_filled_ratio\"\nthreshold = 10\n"),
              ElementsAre(HasSubstr("is a share, and never above 10; was it in per cent? That is 0.1")));
}

TEST(OddInput, AWindowWithoutTheStrongPart) {
  const auto warned = [](const char* window) {
    std::vector<std::string> warnings;
    const Scenario scenario =
        parse_scenario(examples / "01-tunnel.toml", {fmt::format("motion[0].window={}", window)});
    const auto motions = read_motions(scenario, warnings);
    warnings.clear();
    add_shaking_warnings(scenario, motions, warnings);
    return warnings;
  };
  EXPECT_THAT(warned("[20, 29]"), Contains(HasSubstr("the strong part of the shaking is left out")));
  EXPECT_THAT(warned("[0, 20]"), Not(Contains(HasSubstr("the strong part"))));
}

TEST(OddInput, TheEarthquakeOfAStageIsAFact) {
  std::vector<std::string> warnings;
  const Scenario scenario = parse(shaken_blocks, {"stage.shaken.scale=2"});
  const auto facts = earthquake_facts(scenario, read_motions(scenario, warnings));
  EXPECT_THAT(facts, ElementsAre(GroundFact{"earthquake", "0.2 g horizontal in the section"}));
  const Scenario half = parse(shaken_blocks, {"stage.shaken.duration=1"});
  EXPECT_THAT(
      earthquake_facts(half, read_motions(half, warnings)),
      ElementsAre(GroundFact{"earthquake",
                             "0.1 g horizontal in the section, 50 % of the Arias intensity in the window"}));
}

/// On the right face of the upper block of 52 kN/m.
std::string line_load(const char* traction) {
  return two_blocks + "[[load]]\nblock = \"top\"\nfrom = [3, 1]\nto = [3, 2]\ntraction = " + traction + "\n";
}

TEST(OddInput, LoadsThatAreWeakOrPull) {
  EXPECT_THAT(warnings_of(line_load("[-30e3, 0]")), IsEmpty());
  EXPECT_THAT(
      warnings_of(line_load("[-30, 0]")),
      Contains(HasSubstr("load[0] (line 25): 30 N/m, 0.059 % of the weight of its block of 51 kN/m; was it "
                         "in kPa?")));
  EXPECT_THAT(warnings_of(line_load("[30e3, 0]")),
              ElementsAre(HasSubstr("load[0] (line 25): pulls the face outwards by 3e+04 N/m")));
  EXPECT_THAT(warnings_of(line_load("[0, -30e3]")), IsEmpty()) << "shear";
  EXPECT_THAT(warnings_of(line_load("[30e3, 0]"), {"accept_warnings=['loads']"}), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks + "[[load]]\nblock = \"top\"\npoint = [2, 1.5]\nforce = [25, 0]\n"),
              ElementsAre(HasSubstr("was it in kN/m?")));
}

TEST(OddInput, DisplacementsThatGoFar) {
  EXPECT_THAT(warnings_of(two_blocks, {"block.base.motion={x=[[0, 0], [1, 5]]}"}),
              ElementsAre(HasSubstr(
                  "block.base.motion (--set): goes 5 m in a model of 4 m; was it in cm? That is 0.05 m")));
  EXPECT_THAT(warnings_of(two_blocks, {"block.base.motion={x=[[0, 0], [1, 0.05]]}"}), IsEmpty());
}

TEST(OddInput, WhatActsIsListed) {
  const auto facts = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
    std::string all;
    for (const GroundFact& fact : ground_facts(parse(text, overrides)))
      all += fact.name + ": " + fact.value + "\n";
    return all;
  };
  EXPECT_THAT(facts(two_blocks), HasSubstr("gravity: 9.81 m/s² ↓\n"));
  EXPECT_THAT(facts(two_blocks, {"gravity=[0, 9.81]"}),
              HasSubstr("gravity: 9.81 m/s² ↑, 180° from downwards"));
  EXPECT_THAT(facts(two_blocks, {"tilt=45"}),
              HasSubstr("gravity: 9.81 m/s² ↙, 45° from downwards, to the left"));
  EXPECT_THAT(facts(line_load("[-30e3, 0]")), HasSubstr("load 1 on “top”: 30 kN/m ← along 1 m\n"));
  EXPECT_THAT(facts(jointed_domain), HasSubstr("around the model: fixed frame, friction 0°\n"));
}

TEST(OddInput, ABlockInAnotherUnit) {
  const auto third = [](double size) {
    return warnings_of(two_blocks +
                       fmt::format("[[block]]\nname = \"far\"\nouter = [[10, 0], [{0}, 0], [{0}, {1}], "
                                   "[10, {1}]]\n",
                                   10.0 + size, size));
  };
  EXPECT_THAT(third(10.0), IsEmpty());
  EXPECT_THAT(third(1000.0),
              ElementsAre(HasSubstr("block.far.outer: a block of 1e+03 m among others of 1.4 to 2 m")));
  EXPECT_THAT(third(0.01),
              ElementsAre(HasSubstr("block.far.outer: a block of 0.01 m among others of 1.4 to 2 m")));
}

/// A tunnel of 4 m; its joints strike with it, and the section is meant to be across.
const std::string tunnel_across = R"(accept_warnings = ["order-1", "plane-stress", "lost-joints"]
[section]
azimuth = 90.0
[domain]
x = [-10, 10]
y = [-10, 10]
[rock]
density = 2600.0
young = 1e9
poisson = 0.2
[joints]
friction = 30.0
[[joint_set]]
name = "J1"
dip = 70
dip_direction = 90
spacing = 1.0
length = 100.0
gap = 0.0
[[joint_set]]
name = "J2"
dip = 60
dip_direction = 270
spacing = 1.0
length = 100.0
gap = 0.0
[time]
step = 0.01
[[excavation]]
name = "tunnel"
shape = "circle"
center = [0, 0]
diameter = 4
[[stage]]
name = "settled"
kind = "settle"
excavate = ["tunnel"]
)";

TEST(OddInput, TheAxisInPlaceOfTheSection) {
  EXPECT_THAT(warnings_of(tunnel_across), Not(Contains(HasSubstr("section.azimuth"))));
  EXPECT_THAT(
      warnings_of(tunnel_across, {"section.azimuth=0"}),
      Contains(AllOf(HasSubstr("section.azimuth = 0 (--set): "), HasSubstr("was it that of the axis?"))));
}

TEST(OddInput, SetsThatLoseMuchOfTheirLength) {
  EXPECT_THAT(warnings_of(tunnel_across, {"accept_warnings=['order-1', 'plane-stress']"}),
              Not(Contains(HasSubstr("end in rock"))));
  EXPECT_THAT(warnings_of(tunnel_across, {"accept_warnings=['order-1', 'plane-stress']",
                                          "joint_set.J1.length=2", "joint_set.J1.gap=2"}),
              Contains(AllOf(HasSubstr("joint_set: "), HasSubstr("% of 'J1'"),
                             HasSubstr("blocks do not break there"))));
}

TEST(OddInput, MapsInOtherUnitsOrWithAxesExchanged) {
  const auto warned = [](const char* lines, const char* box) {
    return warnings_of(runnable_domain,
                       {fmt::format("trace_map=[{{name='M', lines={}}}]", lines), box,
                        "accept_warnings=['plane-stress', 'order-1', 'lost-joints']", "joint_set=[]"});
  };
  const char* box = "domain.x=[-20, 20]";
  EXPECT_THAT(warned("[[[-20, 1], [20, 1.5]], [[-18, 2], [18, 2.2]]]", box),
              Not(Contains(HasSubstr("outside the domain"))));
  EXPECT_THAT(warned("[[[1, -20], [1.5, 20]], [[2, -18], [2.2, 18]]]", box),
              Contains(HasSubstr(
                  "trace_map.M: 92 % of its length lies outside the domain; with x and y exchanged, 100 % "
                  "would lie inside")));
  EXPECT_THAT(warned("[[[-20000, 1000], [20000, 1500]], [[0, 0], [18000, 2200]]]", box),
              Contains(HasSubstr("taken as mm, 100 % would lie inside")));
}

TEST(OddInput, WhatIsALittleAboveTheBase) {
  const auto warned = [](double height) {
    return warnings_of(fmt::format(R"([rock]
density = 2600.0
young = 1e9
poisson = 0.2
[joints]
friction = 30.0
[boundary]
[time]
step = 0.01
[[block]]
outer = [[0, 0], [2, 0], [2, 2], [0, 2]]
[[block]]
outer = [[2, {0}], [4, {0}], [4, 2], [2, 2]]
[[stage]]
name = "quiet"
kind = "settle"
)",
                                   height));
  };
  EXPECT_THAT(warned(0.0), Not(Contains(HasSubstr("the base is at"))));
  EXPECT_THAT(warned(1e-6),
              Contains(HasSubstr("boundary: the base is at 0 m, where 1 of the blocks given one by one has "
                                 "an edge; 1 more lies 1e-06 m above it, or on a corner, and is not held "
                                 "by it")));
}

TEST(OddInput, WhatIsUsual) {
  EXPECT_EQ(unusual_text(usual::damping, 0.05), "");
  EXPECT_EQ(unusual_text(usual::damping, 5.0), "usual is 0.0001 to 1; was it in percent? That is 0.05");
  EXPECT_EQ(unusual_text(usual::depth, 0.06), "usual is 1 to 1e+04 m; was it in km? That is 60 m");
  EXPECT_EQ(unusual_text(usual::depth, 0.0), "") << "zero is meant";
  EXPECT_EQ(unusual_text(usual::peak_acceleration, 0.05),
            "usual is 0.5 to 30 m/s2; was it in g? That is 0.4905 m/s2");
  EXPECT_THAT(warnings_of(two_blocks, {"solver.rock_damping=5"}),
              ElementsAre(HasSubstr("was it in percent? That is 0.05")));
}

}  // namespace
}  // namespace keyblock::scenario
