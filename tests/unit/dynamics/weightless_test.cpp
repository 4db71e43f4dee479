// Models without gravity: steps are measured by what makes them, so that each solver has to solve them.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../one_step.h"
#include "../scene.h"

namespace keyblock::simulation {
namespace {

using dynamics::LinearSolver;

constexpr double weightless_step = 0.0005;
constexpr LinearSolver all_solvers[] = {LinearSolver::block, LinearSolver::direct, LinearSolver::iterative};

Scene weightless(double friction = 40.0) {
  Scene scene(2e9, friction, 2500.0);
  scene.setup.gravity = {};
  return scene;
}

/// Two blocks, 5 cm apart.
Scene apart_by_5_cm(bool second_is_fixed = false, int order = 1) {
  Scene scene = weightless();
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, false, order);
  scene.rectangle({1.05, 0.0}, 1.0, 1.0, 0.0, second_is_fixed, order);
  return scene;
}

/// m and m/s along x, of every block, by one solver.
std::vector<Vec2> run_by(LinearSolver solver, Scene scene, double duration,
                         const dynamics::GroundAcceleration* ground = nullptr) {
  scene.setup.solver.linear = solver;
  Simulator s(scene);
  std::vector<Vec2> start, moved;
  for (int b = 0; b < static_cast<int>(s.model.blocks.size()); ++b) start.push_back(s.centroid(b));
  s.run(duration, weightless_step, ground);
  EXPECT_EQ(s.unconverged, 0);
  for (int b = 0; b < static_cast<int>(start.size()); ++b)
    moved.push_back({s.centroid(b).x - start[static_cast<std::size_t>(b)].x, s.velocity(b).x});
  return moved;
}

/// The first of these all_solvers against the others.
void expect_same_by_all(const Scene& scene, double duration, double scale,
                        const dynamics::GroundAcceleration* ground = nullptr) {
  const std::vector<Vec2> expected = run_by(all_solvers[0], scene, duration, ground);
  for (const LinearSolver solver : all_solvers) {
    const std::vector<Vec2> found = run_by(solver, scene, duration, ground);
    for (std::size_t b = 0; b < found.size(); ++b) {
      EXPECT_NEAR(found[b].x, expected[b].x, 1e-6 * scale) << static_cast<int>(solver) << ", block " << b;
      EXPECT_NEAR(found[b].y, expected[b].y, 1e-6 * scale) << static_cast<int>(solver) << ", block " << b;
    }
  }
}

// 2,500 kg at 1 m/s.
TEST(Weightless, ABlockThatIsThrownGivesItsMomentumAway) {
  for (const int order : {1, 2, 3}) {
    Scene scene = apart_by_5_cm(false, order);
    scene.setup.properties[0].velocity = {1.0, 0.0};
    expect_same_by_all(scene, 0.2, 1.0);
    for (const LinearSolver solver : all_solvers) {
      const std::vector<Vec2> moved = run_by(solver, scene, 0.2);
      EXPECT_NEAR(moved[0].y + moved[1].y, 1.0, 1e-6);
      EXPECT_NEAR(moved[0].x + moved[1].x, 0.2, 1e-6);
      EXPECT_GT(moved[1].y, 0.4);
    }
  }
}

TEST(Weightless, ABlockIsThrownAtAWall) {
  Scene scene = apart_by_5_cm(true);
  scene.setup.properties[0].velocity = {1.0, 0.0};
  expect_same_by_all(scene, 0.2, 1.0);
  EXPECT_LT(run_by(LinearSolver::iterative, scene, 0.2)[0].y, -0.1);
}

// Before it comes, and after it is over, it has no force.
TEST(Weightless, ALoadThatComesLateAndGoesLeavesItsImpulse) {
  Scene scene = apart_by_5_cm();
  loading::Load load;
  load.block = "b0";
  load.from = load.to = {0.5, 0.5};
  load.value = load.value_end = {-2.5e6, 0.0};
  load.factor = loading::TimeTable({{0.0, 0.0}, {0.01, 0.0}, {0.02, 1.0}, {0.03, 0.0}});
  scene.setup.loads.push_back(load);
  scene.setup.properties[1].velocity = {0.5, 0.0};
  expect_same_by_all(scene, 0.1, 10.0);
  for (const LinearSolver solver : all_solvers) {
    const std::vector<Vec2> moved = run_by(solver, scene, 0.1);
    EXPECT_NEAR(moved[0].y, -10.0, 1e-5);  // 25 kN s of 2,500 kg
    EXPECT_NEAR(moved[1].y, 0.5, 1e-5);    // beside a force of 2.5 MN
  }
}

// The load measures no block while it has no force; the other block falls at once.
TEST(Weightless, ALoadThatWaitsDoesNotHoldABlockInTheAir) {
  for (const LinearSolver solver : all_solvers) {
    Scene scene(2e9, 40.0, 2500.0);
    scene.setup.solver.linear = solver;
    scene.rectangle({0.0, 0.0}, 1.0, 1.0);
    loading::Load load;
    load.block = "b0";
    load.from = load.to = {0.5, 0.5};
    load.value = load.value_end = {1e9, 0.0};
    load.factor = loading::TimeTable({{0.0, 0.0}, {1.0, 0.0}, {2.0, 1.0}});
    scene.setup.loads.push_back(load);
    Simulator s(scene);
    s.run(0.1, weightless_step);
    EXPECT_NEAR(s.velocity(0).y, -0.1 * g, 1e-4) << static_cast<int>(solver);
  }
}

// Nothing has a momentum before the wall moves, and no force acts but that of the joint.
TEST(Weightless, AWallThatMovesPushesABlock) {
  Scene scene = weightless();
  scene.rectangle({-1.0, 0.0}, 1.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.setup.properties[0].motion_x = loading::TimeTable({{0.0, 0.0}, {0.05, 0.0}, {0.1, 0.05}});
  expect_same_by_all(scene, 0.1, 1.0);
  EXPECT_GT(run_by(LinearSolver::iterative, scene, 0.1)[1].y, 0.9);
}

TEST(Weightless, ASupportThatMovesPullsABlock) {
  Scene scene = weightless();
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  loading::Support support;
  support.block = "b0";
  support.points = {{0.0, 0.0}, {0.0, 1.0}};
  support.motion_x = loading::TimeTable({{0.0, 0.0}, {0.05, 0.0}, {0.1, 0.05}});
  scene.setup.supports.push_back(support);
  expect_same_by_all(scene, 0.1, 1.0);
  EXPECT_NEAR(run_by(LinearSolver::iterative, scene, 0.1)[0].x, 0.05, 1e-3);
}

// The ground shakes by A sin ωt; against it a block that nothing touches moves by A/ω² (sin ωt − ωt). Where the record crosses zero there is
// no force.
TEST(Weightless, ShakingGoesOnWhereTheRecordCrossesZero) {
  const Sine sine({2.0, 0.0}, 5.0);
  Scene scene = apart_by_5_cm();
  expect_same_by_all(scene, 0.21, 1.0, &sine);
  const double w = sine.omega(), t = 0.21;
  for (const LinearSolver solver : all_solvers) {
    const Vec2 moved = run_by(solver, scene, t, &sine)[0];
    EXPECT_NEAR(moved.y, 2.0 / w * (std::cos(w * t) - 1.0), 1e-6) << static_cast<int>(solver);
    EXPECT_NEAR(moved.x, 2.0 / (w * w) * (std::sin(w * t) - w * t), 2e-4) << static_cast<int>(solver);
  }
}

// Joints that just touch press by the rounding of their places: no step may be given up for that.
TEST(Weightless, BlocksAtRestStayAtRest) {
  for (const LinearSolver solver : all_solvers) {
    Scene scene = weightless();
    scene.setup.solver.linear = solver;
    scene.rectangle({0.1, 0.3}, 0.7, 0.7, 17.0);
    scene.rectangle(Vec2{0.1, 0.3} + 0.7 * direction(17.0), 0.7, 0.7, 17.0);
    Simulator s(scene);
    s.run(0.02, weightless_step);
    EXPECT_EQ(s.unconverged, 0);
    for (const int b : {0, 1}) EXPECT_LT(norm(s.velocity(b)), 1e-9);
  }
}

// Its energy falls by 20 orders of magnitude.
TEST(Weightless, WhatIsDampedToRestConverges) {
  for (const LinearSolver solver : all_solvers) {
    Scene scene = weightless();
    scene.setup.solver.linear = solver;
    scene.rectangle({0.0, 0.0}, 1.0, 1.0);
    loading::Support support;
    support.block = "b0";
    support.points = {{0.0, 0.0}, {0.0, 1.0}};
    scene.setup.supports.push_back(support);
    scene.setup.properties[0].velocity = {1.0, 0.5};
    Simulator s(scene);
    s.run(3.0, weightless_step);
    EXPECT_EQ(s.unconverged, 0);
    EXPECT_LT(norm(s.velocity(0)), 1e-10);
  }
}

TEST(Weightless, AForceThatNothingMeasuresIsInfinitelyOutOfBalance) {
  Scene scene(0.0, 40.0);  // rock without stiffness has no elastic force, not even by rounding
  scene.setup.gravity = {};
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  Simulator s(scene);
  const auto solver = linalg::make_block_cholesky(linalg::Precision::full);
  const dynamics::OneStep step(s, *solver);
  std::vector<double> force(s.model.coefficients, 0.0);
  EXPECT_FALSE(step.problem.terms().has_weights());
  EXPECT_EQ(step.problem.terms().residual_ratio(force), 0.0);
  force[0] = 1e-30;
  EXPECT_EQ(step.problem.terms().residual_ratio(force), std::numeric_limits<double>::infinity());
}

TEST(Weightless, MomentumMeasuresAStep) {
  Scene scene = apart_by_5_cm();
  scene.setup.properties[0].velocity = {1.0, 0.0};
  Simulator s(scene);
  const auto solver = linalg::make_block_cholesky(linalg::Precision::full);
  const dynamics::OneStep step(s, *solver);
  EXPECT_TRUE(step.problem.terms().has_weights());
  // (1 + θ) ρ v √A/Δt, with θ = 1 and 5 ms, and a thousandth of it.
  for (const std::size_t b : {0U, 1U})
    EXPECT_NEAR(step.problem.terms().weight(b), 1e-3 * 2.0 * 2500.0 / 0.005, 1e-6);
}

}  // namespace
}  // namespace keyblock::simulation
