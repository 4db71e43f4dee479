#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>

#include "../fresh_folder.h"
#include "scenario/build.h"
#include "scenario/far_rock.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// 20 m of uniform ground in bonded blocks of 2 m, as stiff as the rock.
const std::string shaken_ground = R"(
accept_warnings = ["order-1"]
[section]
azimuth = 90
[domain]
x = [-10, 10]
y = [-20, 0]
[rock]
density = 2200
young = 1e9
poisson = 0.25
state = "plane-strain"
[joints]
friction = 40
normal_stiffness = 1e12
shear_stiffness = 1e12
[[joint_set]]
name = "H"
dip = 0
dip_direction = 90
spacing = { mean = 2.0, distribution = "constant" }
length = { mean = 1000.0, distribution = "constant" }
gap = { mean = 0.0, distribution = "constant" }
cohesion = 1e12
tension = 1e12
[[joint_set]]
name = "V"
dip = 90
dip_direction = 90
spacing = { mean = 2.0, distribution = "constant" }
length = { mean = 1000.0, distribution = "constant" }
gap = { mean = 0.0, distribution = "constant" }
cohesion = 1e12
tension = 1e12
[in_situ]
depth = 0
k0 = 1
[time]
step = 0.002
[[excavation]]
name = "tunnel"
shape = "polygon"
outer = [[-2, -12], [2, -12], [2, -8], [-2, -8]]
[[motion]]
name = "m"
x = [[0, 0], [0.5, 0], [0.6, 1], [0.8, -1], [0.9, 0], [2, 0]]
[[stage]]
name = "settled"
kind = "settle"
excavate = ["tunnel"]
[[stage]]
name = "quiet"
kind = "rest"
duration = 1
until = "still"
[[stage]]
name = "shaken"
kind = "shake"
motion = "m"
)";
const std::string let_out = "boundary={base='compliant', sides='free-field'}";

std::vector<std::string> warned_of_ground(const std::vector<std::string>& overrides,
                                          const std::string& more = "") {
  std::vector<std::string> warnings;
  build_setup(parse(shaken_ground + more, overrides), 0, &warnings);
  return warnings;
}

std::string said_of(const simulation::RunSetup& setup) {
  std::string all;
  for (const auto& [name, value] : setup.ground) all += fmt::format("{}: {}\n", name, value);
  return all;
}

// ρ v_s v of 0.1 m/s in 2200 kg/m³ and 426 m/s is 94 kPa.
TEST(EarthquakeChecks, AClosedBoxLeavesTheWaveOut) {
  EXPECT_THAT(warned_of_ground({}), Contains(HasSubstr("closed box: wave stress of 0.09")));
  EXPECT_THAT(warned_of_ground({"accept_warnings=['order-1', 'closed-box']"}),
              Not(Contains(HasSubstr("closed box"))));
  EXPECT_THAT(said_of(build_setup(parse(shaken_ground, {"accept_warnings=['order-1', 'closed-box']"}), 0)),
              HasSubstr("around the model: closed box: wave stress of 0.09"));
  EXPECT_THAT(warned_of_ground({let_out}), IsEmpty());
  EXPECT_THAT(warned_of_ground({"motion.m.x={amplitude=1, frequency=2, cycles=3}"}),
              Contains(HasSubstr("closed box: wave stress of 0.15 MPa")))
      << "waves of any motion";
}

TEST(EarthquakeChecks, WhatHangsLooseIsNotTheEarthquakes) {
  EXPECT_THAT(warned_of_ground({let_out, "stage.quiet.until=duration"}),
              Contains(HasSubstr("stage.shaken: what hangs loose and is not down after 1 s of 'quiet'")));
  EXPECT_THAT(warned_of_ground({let_out, "stage.quiet={name='quiet', kind='settle'}"}),
              Contains(HasSubstr("comes down during the shaking")));
}

TEST(EarthquakeChecks, RockIsNotTakenOutWhileTheBaseLetsWavesOut) {
  const std::vector<std::string> late{let_out, "stage.settled.excavate=[]",
                                      "stage.quiet.excavate=['tunnel']"};
  EXPECT_THAT(refusal(parse(shaken_ground, late)),
              HasSubstr("stage.quiet.excavate: found 345.3 kN/m of rock taken out while the base lets waves "
                        "out; nothing would carry the change, and the model would rise by some"));
  EXPECT_EQ(refusal(parse(shaken_ground, {"boundary={base='rigid'}", late[1], late[2]})), "");
  EXPECT_EQ(refusal(parse(shaken_ground, {late[1], late[2]})), "");
}

TEST(EarthquakeChecks, DampingThatWavesDoNotHave) {
  const auto damped = [](const char* kind) {
    return warned_of_ground(
        {let_out, std::string("solver.damping={ratio=0.05, frequency=3, kind='") + kind + "'}"});
  };
  EXPECT_THAT(damped("stiffness"), IsEmpty());
  EXPECT_THAT(damped("rayleigh"), Contains(HasSubstr("damped by 2.5 % at 3 Hz, half of what is asked")));
  EXPECT_THAT(damped("mass"), Contains(HasSubstr("damped by 0 % at 3 Hz, nothing of what is asked")));
  EXPECT_THAT(
      said_of(build_setup(
          parse(shaken_ground, {let_out, "solver.damping={ratio=0.05, frequency=3, kind='rayleigh'}"}), 0)),
      HasSubstr("damping of waves at 1, 3, 10, 30 Hz, with that of the rule: 0.83, 2.5, 8.4, 27 %"));
}

// A block of 5830 kg/m on 2.2e7 N/m swings at 9.8 Hz. Shi's rule takes ω Δt/4 where supports hold it, and (ω Δt)³/16 where springs between points do.
TEST(EarthquakeChecks, SpringsThatTheRuleDamps) {
  const std::string hung = R"(
[rock]
density = 2650
young = 5e10
poisson = 0.2
[joints]
friction = 30
[time]
step = 0.002
[[block]]
name = "roof"
fixed = true
outer = [[-1, 3], [1, 3], [1, 4], [-1, 4]]
[[block]]
name = "stone"
outer = [[-0.75, 0], [0.75, 0], [0.75, 1.4666667], [-0.75, 1.4666667]]
[[support]]
name = "bolt"
block = "stone"
points = [[0, 1.4]]
directions = ["y"]
stiffness = 2.2e7
[[stage]]
name = "hangs"
kind = "rest"
duration = 3
)";
  const auto warnings = [&](const std::vector<std::string>& overrides) {
    std::vector<std::string> all;
    build_setup(parse(hung, overrides), 0, &all);
    return all;
  };
  EXPECT_THAT(warnings({}), Contains(HasSubstr("support.bolt: its block swings on it at 9.78 Hz, where "
                                               "integrator = \"shi\" takes 3.1 % of critical")));
  EXPECT_THAT(warnings({"time.step=0.001"}), IsEmpty());
  EXPECT_THAT(warnings({"solver.integrator=generalized-alpha"}), IsEmpty());
  EXPECT_THAT(warnings({"stage.hangs={name='hangs', kind='settle'}"}), IsEmpty());
  const auto sprung = [](const char* stiffness) {
    return std::vector<std::string>{
        "support=[]",
        std::string("spring=[{name='tie', from=[0, 3], to=[0, 1.4], stiffness=") + stiffness + "}]"};
  };
  EXPECT_THAT(warnings(sprung("2.2e7")), IsEmpty());
  EXPECT_THAT(warnings(sprung("2.2e9")),
              Contains(HasSubstr("spring.tie: its block swings on it at 97.8 Hz")));
}

TEST(EarthquakeChecks, LoadsThatChangeAfterTheEnd) {
  const std::string pushed = two_blocks + R"(
[[load]]
block = "top"
point = [2, 1.5]
force = [1, 0]
time = [[0, 0], [20, 1]]
)";
  std::vector<std::string> warnings;
  build_setup(parse(pushed), 0, &warnings);
  EXPECT_THAT(warnings, Contains(HasSubstr("the run ends at 1 s, but load 1 changes until 20 s")));
}

TEST(FarRock, IsSaid) {
  const std::string said =
      said_of(build_setup(parse(shaken_ground, {"boundary={top='overburden'}", "in_situ.depth=30"}), 0));
  EXPECT_THAT(said, HasSubstr("overburden: its weight, and 30 m of rock in which waves from below go on"));
  EXPECT_THAT(said, HasSubstr("impedance of the half-space"));
  EXPECT_THAT(said, HasSubstr("columns beside the model: -20 to 30 m"));
  EXPECT_THAT(said, HasSubstr("blocks and "));
}

TEST(FarRock, NeedsRockAtTheSides) {
  const std::string tower = R"(
[rock]
density = 2200
young = 1e9
poisson = 0.25
[joints]
friction = 40
[time]
step = 0.002
[[block]]
name = "slab"
outer = [[-1, 0], [11, 0], [11, 1], [-1, 1]]
[[block]]
name = "left wall"
outer = [[-1, 9], [0, 9], [0, 10], [-1, 10]]
[[stage]]
name = "rests"
kind = "rest"
duration = 1
[boundary]
)";
  EXPECT_THAT(refusal(parse(tower)), HasSubstr("boundary: found no rock at the left side"));
}

// Softer ground by a region, by blocks of its own, or by softer joints.
TEST(FarRock, HasLayers) {
  const auto layers = [](const std::vector<std::string>& overrides) {
    return build_setup(parse(shaken_ground, overrides), 0).boundary->layers;
  };
  ASSERT_EQ(layers({let_out}).size(), 1u);
  EXPECT_NEAR(layers({let_out}).front().speeds().x, std::sqrt(4e8 / 2200.0), 1.0);
  const auto two =
      layers({let_out, "region=[{name='soil', outer=[[-10, -6], [10, -6], [10, 0], [-10, 0]], young=1e8}]"});
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two.back().top, -6.0);
  EXPECT_NEAR(two.front().speeds().x, std::sqrt(4e7 / 2200.0), 1.0);
  EXPECT_NEAR(two.back().speeds().x, std::sqrt(4e8 / 2200.0), 8.0);
}

TEST(MotionPlaces, OfARecordInTheGround) {
  const auto refused = [](const std::vector<std::string>& overrides) {
    return refusal(parse(shaken_ground, overrides));
  };
  EXPECT_THAT(mistakes(shaken_ground, {let_out, "motion.m.at=within"}), HasSubstr("motion.m.depth"));
  EXPECT_THAT(mistakes(shaken_ground, {let_out, "motion.m.depth=20"}), HasSubstr("at = \"within\""));
  EXPECT_EQ(refused({let_out, "motion.m.at=within", "motion.m.depth=20"}), "");
  EXPECT_EQ(refused({let_out, "motion.m.at=within", "motion.m.depth=60"}), "");
  EXPECT_THAT(refused({let_out, "motion.m.at=within", "motion.m.depth=10"}),
              HasSubstr("motion.m.depth: found 10 m, with the base 20 m below the ground"));
  EXPECT_EQ(refused({"boundary={base='rigid'}", "motion.m.at=within", "motion.m.depth=20"}), "");
  EXPECT_THAT(refused({"boundary={base='rigid'}", "motion.m.at=within", "motion.m.depth=30"}),
              HasSubstr("a record at the depth of the rigid base"));
  EXPECT_THAT(warned_of_ground({let_out, "motion.m.at=inside"}),
              Contains(HasSubstr("an older word for \"incident\"")));
}

// Known: at the depth H in uniform ground an outcrop of 1 moves by cos(kH).
TEST(MotionPlaces, TheOutcropOfARecordWithin) {
  // Hz: below and above those at which the ground stands still there, 5.3, 16, 26.6.
  for (const double frequency : {3.0, 8.0, 13.5}) {
    const simulation::RunSetup setup = build_setup(
        parse(shaken_ground, {let_out, "time.step=0.002", "motion.m.at=within", "motion.m.depth=20",
                              fmt::format("motion.m.x={{amplitude=1, frequency={}, cycles={}}}", frequency,
                                          12.0 * frequency)}),
        0);
    // Drag makes it too large by ½ πζ, 1.6 %; elements by some 0.4 % at 8 Hz.
    // What is at this frequency in the last 6 s, whole cycles: the vibration of the start is not.
    const loading::GroundMotion& motion = setup.motions.front();
    std::complex<double> found;
    constexpr int samples = 6000;
    for (int k = 0; k < samples; ++k) {
      const double t = 6.0 + 1e-3 * k;
      found += motion.at(t).x * std::polar(2.0 / samples, -2.0 * M_PI * frequency * t);
    }
    const double largest = std::abs(found);
    const double speed = setup.boundary->layers.front().speeds().x;
    const double known = 1.0 / std::abs(std::cos(2.0 * M_PI * frequency * 20.0 / speed));
    EXPECT_NEAR(largest, known, 0.022 * known) << frequency << " Hz";
  }
}

// Its samples are as far apart as those of the record.
TEST(MotionPlaces, TheOutcropOfARecordHasItsSampling) {
  const FreshFolder folder;
  const std::filesystem::path record = folder / "record.csv";
  std::ofstream(record) << "time,acceleration\n0,0\n0.01,1\n0.02,-1\n0.03,0.5\n0.04,0\n";
  EXPECT_THAT(warned_of_ground({let_out, "time.step=0.01",
                                "motion.m={name='m', at='within', depth=20, x={file='" + record.string() +
                                    "', unit='m/s2'}}"}),
              Not(Contains(HasSubstr("longer than the step"))));
}

TEST(MotionPlaces, AFileAtDepthIsNoOutcrop) {
  const FreshFolder folder;
  const std::filesystem::path record = folder / "AAA.EW1";
  std::ofstream(record) << "Origin Time       2020/01/01 00:00:00\nMag.              6.0\n"
                           "Station Code      XXX001\nSampling Freq(Hz) 100Hz\nDuration Time(s)  0.1\n"
                           "Dir.              2\nScale Factor      2000(gal)/4000\nMemo.             \n"
                           "     100      110       90      130       70      160       40      220 \n"
                           "     -20      105 \n";
  const std::string recorded = "motion.m={name='m', components=[{file='" + record.string() + "'}]";
  const auto refused = [&](const std::string& more) {
    return refusal(parse(shaken_ground, {let_out, recorded + more + "}"}));
  };
  EXPECT_THAT(refused(""), HasSubstr("recorded at depth"));
  EXPECT_THAT(refused(", at='outcrop'"), HasSubstr("expected \"within\", with its depth"));
  EXPECT_THAT(refused(", at='incident'"), HasSubstr("recorded at depth"));
  EXPECT_EQ(refused(", at='within', depth=20"), "");
}

}  // namespace
}  // namespace keyblock::scenario
