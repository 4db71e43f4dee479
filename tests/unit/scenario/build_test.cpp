#include "scenario/build.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "scenario/inputs.h"
#include "scenario/sections.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using cutting::EdgeKind;
using cutting::EdgeLabel;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

const std::filesystem::path examples = std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "examples";

// A stage, so that the domain can be run.
const std::string runnable_domain = jointed_domain + R"(
[time]
step = 0.01

[[excavation]]
name = "tunnel"
shape = "circle"
center = [2.0, 1.5]
diameter = 1.0

[[stage]]
name = "settled"
kind = "settle"
excavate = ["tunnel"]
)";

double total_area(const cutting::BlockSystem& system) {
  double sum = 0.0;
  for (const auto& block : system.blocks) sum += area(block.polygon);
  return sum;
}

std::string refusal(const Scenario& scenario) {
  try {
    build_setup(scenario, 0);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

std::vector<std::string> warnings_of(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> warnings;
  build_setup(parse(text, overrides), 0, &warnings);
  return warnings;
}

TEST(BuildBlocks, FillTheDomainAndKnowTheirEdges) {
  const BlockModel model = build_blocks(parse(runnable_domain), 0);
  EXPECT_GT(model.system.blocks.size(), 3U);
  EXPECT_NEAR(total_area(model.system), 12.0, 1e-9);
  bool joint = false, outline = false, domain = false;
  double excavated = 0.0;
  for (const auto& block : model.system.blocks) {
    if (!block.excavations.empty()) excavated += area(block.polygon);
    for (const auto& ring : block.labels) {
      for (const EdgeLabel label : ring) {
        joint = joint || label == EdgeLabel{EdgeKind::joint_set, 0};
        outline = outline || label == EdgeLabel{EdgeKind::excavation, 0};
        domain = domain || label.kind == EdgeKind::domain;
      }
    }
  }
  EXPECT_TRUE(joint && outline && domain);
  EXPECT_NEAR(excavated, std::abs(signed_area(model.outlines[0])), 1e-3);
}

TEST(BuildBlocks, RealizationsDifferAndAreRepeated) {
  const Scenario s = parse(runnable_domain);
  const BlockModel first = build_blocks(s, 0), again = build_blocks(s, 0), other = build_blocks(s, 1);
  ASSERT_EQ(first.traces.size(), again.traces.size());
  EXPECT_EQ(first.traces[0].a, again.traces[0].a);
  EXPECT_FALSE(first.traces.size() == other.traces.size() && first.traces[0].a == other.traces[0].a);
}

TEST(BuildBlocks, NeedNoStages) {
  const Scenario s = parse(jointed_domain);
  EXPECT_GT(build_blocks(s, 0).system.blocks.size(), 1U);
  EXPECT_THAT(refusal(s), HasSubstr("stage: found nothing; expected at least one [[stage]]"));
}

TEST(BuildBlocks, ExplicitBlocksComeLastWithFreeEdges) {
  const Scenario s =
      parse(runnable_domain +
            "[[block]]\nname = \"plug\"\nouter = [[1.8, 1.3], [1.8, 1.6], [2.1, 1.6], [2.1, 1.3]]\n");
  const BlockModel model = build_blocks(s, 0);
  const cutting::CutBlock& plug = model.system.blocks.back();
  EXPECT_NEAR(area(plug.polygon), 0.09, 1e-12);
  EXPECT_EQ(plug.excavations, std::vector{0});
  EXPECT_EQ(plug.labels, (std::vector<std::vector<EdgeLabel>>{std::vector<EdgeLabel>(4)}));
  EXPECT_EQ(build_setup(s, 0).properties.back().name, "plug");
}

TEST(BuildBlocks, TracesOfAMapThatIsFarAway) {
  const Scenario s = parse_scenario(examples / "05-trace-map.toml");
  const auto setup = build_setup(s, 0);
  EXPECT_GT(norm(setup.system.origin), 6e6);
  EXPECT_NEAR(total_area(setup.system), 12.0 * 22.0, 1e-6);
  EXPECT_NEAR((setup.domain.min + setup.system.origin).x, 466002.0, 1e-9);
  EXPECT_LT(norm(setup.excavations[0].outline[0]), 100.0);
  EXPECT_NEAR((setup.excavations[0].outline[0] + setup.system.origin).y, 6691588.5, 1e-6);
  EXPECT_EQ(setup.trace_map_names, std::vector<std::string>{"KB11"});
  EXPECT_EQ(setup.joints.trace_maps[0].friction, 30.0);
  EXPECT_NEAR(setup.in_situ->reference_y + setup.system.origin.y, 6691600.0, 1e-6);
}

TEST(BuildBlocks, ExplicitBlocksThatAreFarAwayTakeAllThatActsAlong) {
  const std::string far = R"([rock]
density = 2600.0
young = 1e9
poisson = 0.2
[time]
step = 0.01
[[block]]
name = "b"
outer = [[500000, 6000000], [500001, 6000000], [500001, 6000001], [500000, 6000001]]
[[load]]
block = "b"
from = [500000, 6000001]
to = [500001, 6000001]
traction = [0, -1]
[[support]]
block = "b"
points = [[500000, 6000000], [500001, 6000000]]
[[history]]
name = "h"
point = [500000.5, 6000000.5]
[[stage]]
name = "s"
kind = "settle"
)";
  const auto setup = build_setup(parse(far), 0);
  EXPECT_EQ(setup.system.origin, (Vec2{500000.0, 6000000.0}));
  EXPECT_EQ(setup.system.blocks[0].polygon.outer[2], (Vec2{1.0, 1.0}));
  EXPECT_EQ(setup.loads[0].to, (Vec2{1.0, 1.0}));
  EXPECT_EQ(setup.supports[0].points[1], (Vec2{1.0, 0.0}));
  EXPECT_EQ(setup.histories[0].point, (Vec2{0.5, 0.5}));
}

TEST(BuildSetup, RockOfBlockBeforeRegionBeforeRock) {
  const auto setup = build_setup(parse(two_blocks + R"(
[[region]]
outer = [[0, 1], [4, 1], [4, 3], [0, 3]]
young = 2e9
order = 2
density = 2000.0

[[region]]
outer = [[0, 1], [4, 1], [4, 3], [0, 3]]
order = 3
)",
                                       {"block.top.density=1000"}),
                                 0);
  EXPECT_EQ(setup.properties[0].material, (Material{2600.0, 1e9, 0.2, PlaneState::plane_stress}));
  EXPECT_EQ(setup.properties[0].order, 1);
  EXPECT_TRUE(setup.properties[0].fixed);
  EXPECT_EQ(setup.properties[1].material, (Material{1000.0, 2e9, 0.2, PlaneState::plane_stress}));
  EXPECT_EQ(setup.properties[1].order, 3);
}

TEST(BuildSetup, RegionsActOnCutBlocks) {
  const auto setup = build_setup(
      parse(runnable_domain + "[[region]]\nouter = [[0, 0], [4, 0], [4, 1.5], [0, 1.5]]\norder = 2\n"), 0);
  int soft = 0;
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    const bool below = centroid(setup.system.blocks[b].polygon).y < 1.5;
    EXPECT_EQ(setup.properties[b].order, below ? 2 : 1);
    soft += below;
  }
  EXPECT_GT(soft, 0);
}

TEST(BuildSetup, JointsTakeWhatTheirSetDoesNotSay) {
  const auto setup = build_setup(
      parse(runnable_domain, {"joints.cohesion=1e5", "joints.normal_stiffness=2e10",
                              "joints.shear_stiffness=1e10", "joint_set.bedding.friction=20",
                              "joint_set.bedding.normal_stiffness=4e10", "domain.frame_friction=5"}),
      0);
  EXPECT_EQ(setup.joints.standard.friction, 30.0);
  EXPECT_EQ(setup.joints.standard.normal_stiffness, 2e10);
  EXPECT_EQ(setup.joints.standard.stiffness_ratio, 0.5);
  EXPECT_EQ(setup.joints.joint_sets[0].friction, 20.0);
  EXPECT_EQ(setup.joints.joint_sets[0].cohesion, 1e5);
  EXPECT_EQ(setup.joints.joint_sets[0].normal_stiffness, 4e10);
  EXPECT_EQ(setup.joints.joint_sets[0].stiffness_ratio, 0.25);
  EXPECT_EQ(setup.joints.frame.friction, 5.0);
  EXPECT_EQ(setup.joints.frame.cohesion, 0.0);
}

TEST(BuildSetup, StiffnessIsLeftToTheModelUnlessGiven) {
  const auto setup = build_setup(parse(runnable_domain), 0);
  EXPECT_FALSE(setup.joints.standard.normal_stiffness);
  EXPECT_FALSE(setup.joints.joint_sets[0].normal_stiffness);
  EXPECT_EQ(setup.joints.standard.stiffness_ratio, JointProperties{}.stiffness_ratio);
  EXPECT_EQ(setup.joints.frame.friction, 0.0);
}

TEST(BuildSetup, InSituStressFromDepth) {
  const auto setup = build_setup(parse(runnable_domain, {"in_situ.depth=30", "in_situ.k0=0.5"}), 0);
  ASSERT_TRUE(setup.in_situ);
  const double weight = 2600.0 * 9.81;
  EXPECT_EQ(setup.in_situ->reference_y, 3.0);
  EXPECT_NEAR(setup.in_situ->syy, -weight * 30.0, 1e-6);
  EXPECT_NEAR(setup.in_situ->sxx, -0.5 * weight * 30.0, 1e-6);
  EXPECT_NEAR(setup.in_situ->syy_gradient, weight, 1e-9);
  EXPECT_NEAR(setup.in_situ->sxx_gradient, 0.5 * weight, 1e-9);
  // At the bottom of the domain: 33 m of rock above.
  EXPECT_NEAR(setup.in_situ->syy + setup.in_situ->syy_gradient * (0.0 - 3.0), -weight * 33.0, 1e-6);
}

TEST(BuildSetup, ConstantInSituStress) {
  const auto setup = build_setup(parse(two_blocks, {"in_situ.sxx=-1e6", "in_situ.sxy=2e5"}), 0);
  EXPECT_EQ(setup.in_situ->sxx, -1e6);
  EXPECT_EQ(setup.in_situ->syy, 0.0);
  EXPECT_EQ(setup.in_situ->sxy, 2e5);
  EXPECT_EQ(setup.in_situ->syy_gradient, 0.0);
}

TEST(BuildSetup, TopOfAModelWithoutDomain) {
  EXPECT_EQ(build_setup(parse(two_blocks, {"in_situ.depth=1", "in_situ.k0=1"}), 0).in_situ->reference_y, 2.0);
}

TEST(BuildSetup, WhatTheFileSaysIsPassedOn) {
  const auto setup = build_setup(parse(two_blocks, {"title=t", "seed=7", "gravity=[0, -1]", "damage.slip=0.5",
                                                    "output.contact_interval=2", "solver.linear=direct",
                                                    "block.top.velocity=[1, 2]", "block.top.spin=3"}),
                                 4);
  EXPECT_EQ(setup.title, "t");
  EXPECT_EQ(setup.seed, 7U);
  EXPECT_EQ(setup.realization, 4);
  EXPECT_EQ(setup.gravity, (Vec2{0.0, -1.0}));
  EXPECT_EQ(setup.time_step, 0.01);
  EXPECT_EQ(setup.damage.slip, 0.5);
  EXPECT_EQ(setup.output.contact_interval, 2.0);
  EXPECT_EQ(setup.solver.linear, dynamics::LinearSolver::direct);
  EXPECT_EQ(setup.properties[1].velocity, (Vec2{1.0, 2.0}));
  EXPECT_EQ(setup.properties[1].spin, 3.0);
  EXPECT_FALSE(setup.frame);
  EXPECT_THAT(setup.scenario, HasSubstr("# --set seed=7\n"));
  ASSERT_EQ(setup.stages.size(), 1U);
  EXPECT_EQ(setup.stages[0].duration, 1.0);
}

TEST(BuildSetup, AHistoryNeedsABlock) {
  const std::string history = "[[history]]\nname = \"h\"\npoint = [5.0, 1.0]\n";
  EXPECT_THAT(refusal(parse(runnable_domain + history)), HasSubstr("history.h.point: found [5, 1], outside"));
  EXPECT_EQ(refusal(parse(runnable_domain + history, {"history.h.point=[0.1, 0.1]"})), "");
}

TEST(BuildSetup, AbsurdOrdersAreRefused) {
  EXPECT_THAT(refusal(parse(runnable_domain, {"rock.order=5000"})),
              HasSubstr("expected at most 2e+07 unknowns"));
}

TEST(Motions, TheRecordOfTheTunnelIsProjected) {
  const Scenario s = parse_scenario(examples / "01-tunnel.toml");
  std::vector<std::string> warnings;
  const auto motions = read_motions(s, warnings);
  EXPECT_THAT(warnings, IsEmpty());
  ASSERT_EQ(motions.size(), 1U);
  EXPECT_DOUBLE_EQ(motions[0].duration(), 20.0);
  double largest_x = 0.0, largest_y = 0.0;
  for (const Vec2 a : motions[0].accelerations()) {
    largest_x = std::max(largest_x, std::abs(a.x));
    largest_y = std::max(largest_y, std::abs(a.y));
  }
  EXPECT_NEAR(largest_y, 0.48347, 1e-9);
  EXPECT_GT(largest_x, 0.5);
  EXPECT_LT(largest_x, 1.0441 * std::cos(15.0 * std::numbers::pi / 180.0) +
                           0.70437 * std::sin(15.0 * std::numbers::pi / 180.0));
}

TEST(Motions, MistakesStandWhereTheyAreMade) {
  std::vector<std::string> warnings;
  const Scenario s = parse_scenario(examples / "01-tunnel.toml", {"motion.shafter-1989.window=[5, 100]"});
  try {
    read_motions(s, warnings);
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 1U);
    EXPECT_EQ(error.diagnostics()[0].key, "motion.shafter-1989.window");
    EXPECT_EQ(error.diagnostics()[0].where.file, "--set motion.shafter-1989.window=[5, 100]");
  }
}

TEST(Motions, OtherDirectionsThanTheFileSaysAreWarnedOf) {
  std::vector<std::string> warnings;
  read_motions(parse_scenario(examples / "01-tunnel.toml", {"motion.0.components.0.azimuth=300"}), warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0],
              HasSubstr("motion.shafter-1989.components[0].azimuth is 300°; the file says 360°"));
}

TEST(Motions, OfSeveralComponentsOneMustBeChosen) {
  const std::string text = two_blocks + R"(
[section]
azimuth = 90.0
[[motion]]
name = "three"
components = [{ file = "../motions/excerpt.V2" }]
)";
  const auto read = [&](const std::vector<std::string>& overrides) -> std::string {
    std::vector<std::string> warnings;
    try {
      read_motions(parse(text, overrides), warnings);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(read({}), HasSubstr("expected channel = the number of one of them"));
  EXPECT_EQ(read({"motion.three.components[0].channel=1"}), "");
  EXPECT_THAT(read({"motion.three.components[0].channel=99"}),
              HasSubstr("motion.three.components[0].channel: found the integer 99"));
}

TEST(CheckInputs, MistakesOfAllFilesComeTogether) {
  const Scenario s = parse(jointed_domain + R"(
[[trace_map]]
file = "../motions/README.md"
[[motion]]
name = "record"
components = [{ file = "../motions/README.md", azimuth = 0 }]
)");
  try {
    check_inputs(s);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_GE(error.diagnostics().size(), 2U);
  }
}

TEST(Outline, CircleAndHorseshoe) {
  ExcavationSpec circle;
  circle.center = {1.0, 2.0};
  circle.diameter = 4.0;
  const Ring ring = excavation_outline(circle);
  EXPECT_EQ(ring.size(), 96U);
  EXPECT_NEAR(signed_area(ring), 4.0 * std::numbers::pi, 0.01);
  for (const Vec2 p : ring) EXPECT_NEAR(norm(p - circle.center), 2.0, 1e-12);

  ExcavationSpec horseshoe;
  horseshoe.shape = ExcavationShape::horseshoe;
  horseshoe.invert = {1.0, 0.0};
  horseshoe.width = 4.0;
  horseshoe.wall_height = 1.0;
  const Ring arch = excavation_outline(horseshoe);
  EXPECT_NEAR(signed_area(arch), 4.0 + 2.0 * std::numbers::pi, 0.01);
  EXPECT_NEAR(bounds({arch, {}}).max.y, 3.0, 1e-12);
  horseshoe.arch_height = 1.0;
  // Circular segment: r = 2.5, half angle 53.13°, area r²(α − sin α cos α).
  const double alpha = std::atan2(2.0, 1.5);
  const double segment = 6.25 * (alpha - std::sin(alpha) * std::cos(alpha));
  EXPECT_NEAR(signed_area(excavation_outline(horseshoe)), 4.0 + segment, 0.01);
  horseshoe.wall_height = 0.0;
  Polygon low{excavation_outline(horseshoe), {}};
  EXPECT_NEAR(area(low), segment, 0.01);
  EXPECT_FALSE(self_intersects(low));
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

TEST(Warnings, OfExcavations) {
  EXPECT_THAT(warnings_of(runnable_domain, {"stage.settled.excavate=[]"}),
              UnorderedElementsAre(HasSubstr("excavation.tunnel: no stage excavates it")));
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.center=[4, 2]"}),
              UnorderedElementsAre(HasSubstr("reaches beyond the domain")));
  EXPECT_THAT(warnings_of(runnable_domain, {"excavation.tunnel.center=[14, 2]"}),
              UnorderedElementsAre(HasSubstr("reaches beyond the domain"), HasSubstr("holds no block")));
}

TEST(Warnings, OfStages) {
  const std::string shaken = runnable_domain + R"(
[[motion]]
name = "sine"
x = { amplitude = 1.0, frequency = 1.0, cycles = 1 }
[[stage]]
name = "shaken"
kind = "shake"
motion = "sine"
)";
  EXPECT_THAT(warnings_of(shaken), UnorderedElementsAre(HasSubstr("comes down during the shaking")));
  EXPECT_THAT(warnings_of(shaken, {"stage.settled.excavate=[]", "stage.shaken.excavate=['tunnel']"}),
              UnorderedElementsAre(HasSubstr("shakes before the rock has settled")));
  EXPECT_THAT(plausibility_warnings(parse(jointed_domain)), UnorderedElementsAre(HasSubstr("no [[stage]]")));
}

TEST(Warnings, OfBlocksThatOverlap) {
  EXPECT_THAT(warnings_of(two_blocks), IsEmpty());
  EXPECT_THAT(warnings_of(two_blocks, {"block.top.outer=[[1, 0.9], [3, 0.9], [3, 2], [1, 2]]"}),
              UnorderedElementsAre(HasSubstr("block.base and block.top overlap by 0.1 m at")));
}

TEST(Warnings, OfDistributionsThatAreCutOff) {
  EXPECT_THAT(
      warnings_of(runnable_domain, {"joint_set.bedding.gap={mean=0.5, std=0.5, distribution=\"normal\"}"}),
      UnorderedElementsAre(HasSubstr("joint_set.bedding.gap: cut off at zero")));
}

TEST(Blocks, AreTurnedBeforeTheRun) {
  const auto top = [](const std::string& key) { return parse(two_blocks, {key}).blocks[1].polygon.outer; };
  const Ring about_centroid = top("block.top.rotation=90.0");
  const Ring expected{{2.5, 0.5}, {2.5, 2.5}, {1.5, 2.5}, {1.5, 0.5}};
  ASSERT_EQ(about_centroid.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_LT(norm(about_centroid[k] - expected[k]), 1e-12);
  const Ring about_corner = parse(two_blocks, {"block.top.rotation=90.0", "block.top.rotation_center=[1, 1]"})
                                .blocks[1]
                                .polygon.outer;
  EXPECT_LT(norm(about_corner[0] - Vec2{1.0, 1.0}), 1e-12);
  EXPECT_LT(norm(about_corner[1] - Vec2{1.0, 3.0}), 1e-12);
}

TEST(Blocks, FixedOnesFollowAPrescribedMotion) {
  const auto setup = build_setup(parse(two_blocks, {"block.base.motion={x = [[0, 0], [1, 0.5]]}"}), 0);
  EXPECT_EQ(setup.properties[0].motion_x(0.5), 0.25);
  EXPECT_TRUE(setup.properties[0].motion_y.empty());
  EXPECT_TRUE(setup.properties[1].motion_x.empty());
}

TEST(Loads, TractionIsAParabolaThroughThreeValues) {
  const std::string loaded = two_blocks + R"(
[[load]]
block = "top"
from = [1, 2]
to = [3, 2]
traction = [1, 0]
traction_middle = [3, -2]
traction_end = [2, 0]
)";
  const loading::Load load = parse(loaded).loads[0];
  EXPECT_EQ(load.traction(0.0).x, 1.0);
  EXPECT_EQ(load.traction(0.5).x, 3.0);
  EXPECT_EQ(load.traction(1.0).x, 2.0);
  EXPECT_DOUBLE_EQ(load.traction(0.25).y, -1.5);
}

TEST(Examples, AllCanBeBuilt) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(examples)) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    EXPECT_EQ(refusal(parse_scenario(entry.path())), "") << entry.path();
  }
  EXPECT_GE(count, 5);
}

}  // namespace
}  // namespace keyblock::scenario
