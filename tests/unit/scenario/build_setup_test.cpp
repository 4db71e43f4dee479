#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenario/build.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

using testing::HasSubstr;

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
  EXPECT_EQ(setup.properties[0].material,
            (block::Material{2600.0, 1e9, 0.2, block::PlaneState::plane_stress}));
  EXPECT_EQ(setup.properties[0].order, 1);
  EXPECT_TRUE(setup.properties[0].fixed);
  EXPECT_EQ(setup.properties[1].material,
            (block::Material{1000.0, 2e9, 0.2, block::PlaneState::plane_stress}));
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

TEST(BuildSetup, StrengthOfAllJointsIsDividedByTheFactor) {
  const auto setup = build_setup(
      parse(runnable_domain, {"joints.cohesion=1e5", "joints.tension=1e4", "joint_set.bedding.friction=20",
                              "domain.frame_friction=5", "joints.strength_factor=2"}),
      0);
  const double degree = std::numbers::pi / 180.0;
  EXPECT_NEAR(std::tan(setup.joints.standard.friction * degree), 0.5 * std::tan(30.0 * degree), 1e-12);
  EXPECT_NEAR(std::tan(setup.joints.joint_sets[0].friction * degree), 0.5 * std::tan(20.0 * degree), 1e-12);
  EXPECT_EQ(setup.joints.joint_sets[0].cohesion, 5e4);
  EXPECT_EQ(setup.joints.standard.tension, 5e3);
  EXPECT_EQ(setup.joints.frame.friction, 5.0);
}

TEST(BuildSetup, TiltTurnsGravityAndLoadsHaveAFactor) {
  const auto setup = build_setup(parse(two_blocks, {"tilt=30", "load_factor=3"}), 0);
  EXPECT_NEAR(setup.gravity.x, -9.81 * 0.5, 1e-12);
  EXPECT_NEAR(setup.gravity.y, -9.81 * std::sqrt(0.75), 1e-12);
  const auto loaded = build_setup(
      parse(std::string(two_blocks) + "[[load]]\nblock = \"top\"\npoint = [2.0, 1.5]\nforce = [1.0, -2.0]\n",
            {"load_factor=3"}),
      0);
  EXPECT_EQ(loaded.loads.at(0).value, (Vec2{3.0, -6.0}));
}

TEST(BuildSetup, StiffnessIsLeftToTheModelUnlessGiven) {
  const auto setup = build_setup(parse(runnable_domain), 0);
  EXPECT_FALSE(setup.joints.standard.normal_stiffness);
  EXPECT_FALSE(setup.joints.joint_sets[0].normal_stiffness);
  EXPECT_EQ(setup.joints.standard.stiffness_ratio, contact::JointProperties{}.stiffness_ratio);
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

TEST(BuildSetup, ASpringNeedsTwoBlocks) {
  const std::string spring = "[[spring]]\nfrom = [0.1, 0.1]\nto = [5.0, 1.0]\nstiffness = 1e6\n";
  EXPECT_THAT(refusal(parse(runnable_domain + spring)),
              HasSubstr(":41:6: spring[0].to: found [5, 1], outside; expected a point of a block"));
  EXPECT_THAT(refusal(parse(runnable_domain + spring, {"spring.0.to=[0.11, 0.1]"})),
              HasSubstr("spring[0].to: found a point of the block of from"));
  EXPECT_EQ(refusal(parse(runnable_domain + spring, {"spring.0.to=[0.9, 0.9]"})), "");
}

TEST(BuildSetup, AStageInstallsSupports) {
  const std::string springs =
      "[[spring]]\nname = \"first\"\nfrom = [0.1, 0.1]\nto = [0.9, 0.9]\nstiffness = 1e6\n"
      "[[spring]]\nname = \"second\"\nfrom = [0.1, 0.2]\nto = [0.9, 0.9]\nstiffness = 1e6\n"
      "[[spring]]\nfrom = [0.2, 0.2]\nto = [0.9, 0.9]\nstiffness = 1e6\n"
      "[[stage]]\nname = \"supported\"\nkind = \"settle\"\ninstall = [\"second\"]\n";
  const simulation::RunSetup setup = build_setup(parse(runnable_domain + springs), 0);
  EXPECT_THAT(setup.staged_supports, ::testing::ElementsAre("second"));
  EXPECT_EQ(setup.springs[0].staged, -1);
  EXPECT_EQ(setup.springs[1].staged, 0);
  EXPECT_EQ(setup.springs[2].staged, -1);
  const auto refused = [&](const std::vector<std::string>& overrides) {
    return mistakes(runnable_domain + springs, overrides);
  };
  EXPECT_THAT(
      refused({"stage.supported.install=['secnd']"}),
      HasSubstr("stage.supported.install[0]: found the string \"secnd\"; expected the name of a "
                "[[spring]], [[bolt]] or [[liner]]: \"first\" or \"second\"; did you mean 'second'?"));
  EXPECT_THAT(refused({"stage.supported.install=['second', 'second']"}),
              HasSubstr("again; expected every name once"));
  EXPECT_THAT(refused({"stage.settled.install=['second']"}),
              HasSubstr("stage.supported.install: found \"second\" again; expected a support that the stage "
                        "'settled' has not installed"));
  EXPECT_THAT(refused({"stage.supported.install='second'"}), HasSubstr("write [\"second\"]"));
  EXPECT_THAT(refused({"spring.first.name=second"}),
              HasSubstr("expected a name that no other [[spring]] has"));
  EXPECT_THAT(refusal(parse(runnable_domain + springs, {"spring.second.to=[5.0, 1.0]"})),
              HasSubstr("spring.second.to: found [5, 1], outside"));
  EXPECT_THAT(
      refusal(parse(runnable_domain + springs, {"spring.second.to=[2.0, 1.5]"})),
      HasSubstr("stage.supported.install: found \"second\", an end of which lies in rock that the stage "
                "'settled' excavates; expected a support between blocks that are there"));
}

TEST(BuildSetup, AHistoryOfRockFarAwayNeedsAColumn) {
  const std::string history = "[[history]]\nname = \"h\"\ncolumn = \"left\"\ny = 1.0\n";
  const std::vector<std::string> around{"boundary={sides='free-field'}"};
  EXPECT_THAT(
      mistakes(runnable_domain + history),
      HasSubstr("history.h.column: found no [boundary]; expected a [boundary] with rock beside the model"));
  EXPECT_THAT(mistakes(runnable_domain + history, {"boundary={sides='roller'}"}),
              HasSubstr("found sides = \"roller\""));
  EXPECT_EQ(refusal(parse(runnable_domain + history, around)), "");
  EXPECT_THAT(mistakes(runnable_domain + history, {around[0], "history.h.point=[1, 1]"}),
              HasSubstr("history.h.point"));
  EXPECT_THAT(mistakes(runnable_domain + history, {around[0], "history.h.column=up"}),
              HasSubstr("\"left\" or \"right\""));
  EXPECT_THAT(
      refusal(parse(runnable_domain + history, {around[0], "history.h.y=7"})),
      HasSubstr(
          "history.h.y: found 7, outside; expected a height from the base to the ground there, 0 to 3"));
}

TEST(BuildSetup, AStageTakesAStepAtLeast) {
  const auto refused = [](const std::vector<std::string>& overrides) {
    return refusal(parse(two_blocks, overrides));
  };
  EXPECT_THAT(
      refused({"stage.quiet.duration=0.004"}),
      HasSubstr("stage.quiet.duration: found 0.004 s, 0.4 steps of 0.01 s; expected 1 to 1e+09 steps"));
  EXPECT_THAT(refused({"stage.quiet.duration=0.009"}), HasSubstr("0.9 steps"));
  EXPECT_EQ(refused({"stage.quiet.duration=0.01"}), "");
  const std::string shaken = two_blocks +
                             "[[motion]]\nname = \"m\"\nx = [[0, 0], [0.004, 1]]\n"
                             "[[stage]]\nname = \"shaken\"\nkind = \"shake\"\nmotion = \"m\"\n";
  EXPECT_THAT(refusal(parse(shaken)),
              HasSubstr("stage.shaken: found 0.004 s of motion, 0.4 steps of 0.01 s"));
  EXPECT_THAT(refusal(parse(shaken, {"motion.m.x=[[0, 0], [1e8, 1]]"})), HasSubstr("1e+10 steps"));
  EXPECT_THAT(mistakes(two_blocks, {"time.step=1e-300"}), HasSubstr("time.step: found the number 1e-300"));
}

TEST(BuildSetup, JointsWithoutNumberAreRefusedWhereTheyStand) {
  Scenario scenario = parse(runnable_domain);
  for (const double std : {1e30, 1e200}) {
    scenario.joint_sets[0].set.spacing = {rockmass::DistributionKind::lognormal, 0.3, std};
    EXPECT_THAT(refusal(scenario), HasSubstr("joint_set.bedding: found statistics that give more")) << std;
  }
}

TEST(BuildSetup, ThinBlocksCarryHighOrders) {
  const std::string thin = "block.top.outer=[[1, 3], [2, -1], [1.2, 3.8], [1, 3.9]]";
  EXPECT_EQ(refusal(parse(two_blocks, {thin, "rock.order=12"})), "");
}

TEST(BuildSetup, AbsurdOrdersAreRefused) {
  Scenario scenario = parse(runnable_domain);
  scenario.rock.order = 5000;
  EXPECT_THAT(refusal(scenario), HasSubstr("expected at most 2e+07 unknowns"));
  EXPECT_EQ(mistakes(runnable_domain, {"rock.order=24"}), "");
  EXPECT_EQ(refusal(parse(runnable_domain, {"rock.order=8"})), "");
  for (const char* order : {"25", "1000", "0", "2.5"}) {
    EXPECT_THAT(mistakes(runnable_domain, {std::string("rock.order=") + order}),
                HasSubstr("expected an integer from 1 to 24, or \"auto\""));
  }
  EXPECT_THAT(mistakes(runnable_domain, {"auto_order.highest_order=25"}), HasSubstr("from 1 to 24"));
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

TEST(BuildSetup, HistoriesOfElementsNameOne) {
  const std::string text = two_blocks + R"(
[[spring]]
name = "anchor"
from = [1.0, 0.5]
to = [1.0, 1.5]
stiffness = 1e6

[[history]]
name = "cell"
element = "NAME"
)";
  const auto named = [&](const std::string& name) {
    std::string of = text;
    return of.replace(of.find("NAME"), 4, name);
  };
  const auto setup = build_setup(parse(named("anchor")), 0);
  EXPECT_EQ(setup.histories[0].element, "anchor");
  try {
    build_setup(parse(named("ancor")), 0);
    FAIL();
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().front();
    EXPECT_EQ(d.key, "history.cell.element");
    EXPECT_GT(d.where.line, 1);
    EXPECT_EQ(d.where.column, 11);
    EXPECT_THAT(d.expected, HasSubstr("anchor"));
    EXPECT_THAT(d.hint, HasSubstr("anchor"));
  }
}

}  // namespace
}  // namespace keyblock::scenario
