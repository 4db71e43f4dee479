#include "coupling/point_springs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "../one_step.h"
#include "../scene.h"
#include "core/error.h"

namespace keyblock::dynamics {
namespace {

loading::Spring spring(Vec2 from, Vec2 to, double stiffness) {
  loading::Spring s;
  s.from = from;
  s.to = to;
  s.stiffness = stiffness;
  return s;
}

/// Two blocks in free flight, 1 m apart, with a spring between their centroids.
simulation::Scene pair_in_flight(double stiffness) {
  simulation::Scene scene(1e12, 30.0);
  scene.setup.gravity = {};
  scene.setup.solver.integrator = TimeIntegration::average_acceleration;
  scene.setup.solver.contact_damping = scene.setup.solver.rock_damping = 0.0;
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.rectangle({2.0, 0.0}, 2.0, 1.0);
  scene.setup.springs.push_back(spring({0.5, 0.5}, {3.0, 0.5}, stiffness));
  return scene;
}

/// A block on a base with a spring from its corner to another block beside it, and one to the base.
simulation::Scene tied_blocks(int order) {
  simulation::Scene scene(1e7, 30.0);
  scene.rectangle({-1.0, -1.0}, 6.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5, 0.0, false, order);
  scene.rectangle({2.0, 0.0}, 1.0, 0.5, 0.0, false, 1);
  scene.setup.springs.push_back(spring({1.0, 0.5}, {2.0, 0.25}, 1e6));
  scene.setup.springs.push_back(spring({0.25, 0.4}, {3.5, -0.5}, 3e6));
  return scene;
}

// Blocks swing against each other with the reduced mass, and what both have together goes on as it was.
TEST(PointSprings, SwingsWithTheReducedMass) {
  const double stiffness = 1e7, m = 2600.0 * (1.0 * 2.0) / (1.0 + 2.0),
               period = 2.0 * std::numbers::pi * std::sqrt(m / stiffness);
  simulation::Scene scene = pair_in_flight(stiffness);
  scene.setup.properties[0].velocity = {0.3, 0.0};
  simulation::Simulator s(scene);
  s.run(period, period / 1000.0);
  EXPECT_NEAR(s.velocity(0).x, 0.3, 1e-5);
  EXPECT_NEAR(s.velocity(1).x, 0.0, 1e-5);
  EXPECT_NEAR(s.centroid(0).x - 0.5, 0.1 * period, 1e-6);
  EXPECT_NEAR(s.centroid(1).x - 3.0, 0.1 * period, 1e-6);
}

// It does the same whatever solver finds it, for any number of threads, and with all accelerators off.
TEST(PointSprings, EverySolverFindsTheSameMotion) {
  const auto end = [](LinearSolver linear, int threads, bool plain) {
    simulation::Scene scene = tied_blocks(2);
    simulation::settle_bounds(scene.setup.solver);
    scene.setup.solver.linear = linear;
    scene.setup.properties[1].velocity = {-1.0, 0.0};
    for (const auto& [name, member] : accelerator_names) scene.setup.solver.accelerators.*member = !plain;
    simulation::Simulator s(scene, threads);
    s.run(0.2, 0.002);
    return s.state.position;
  };
  const std::vector<double> expected = end(LinearSolver::block, 1, false);
  EXPECT_EQ(end(LinearSolver::block, 2, false), expected);
  EXPECT_LT(apart(end(LinearSolver::direct, 1, false), expected), 1e-7);
  EXPECT_LT(apart(end(LinearSolver::iterative, 1, false), expected), 1e-7);
  EXPECT_LT(apart(end(LinearSolver::block, 1, true), expected), 1e-7);
}

class PointSpringsOrder : public ::testing::TestWithParam<int> {};

// The gradient by way of vertices and points is the gradient row by row, and the matrix its derivative.
TEST_P(PointSpringsOrder, MatrixIsTheDerivativeOfTheGradient) {
  simulation::Scene scene = tied_blocks(GetParam());
  scene.setup.properties[1].velocity = {-1.0, 0.2};
  simulation::Simulator s(scene);
  s.run(0.05, 0.005);
  const auto solver = linalg::make_block_cholesky(linalg::Precision::full);
  OneStep step(s, *solver);
  ASSERT_EQ(step.problem.rows().size(), step.contacts.size() + 2);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> direction(step.d.size(), 0.0), up(step.d.size()), down(step.d.size());
  for (std::size_t k = 0; k < s.model.unknowns; ++k) direction[k] = uniform(random);
  const double h = 1e-9;
  const auto gradient = [&](double alpha, std::vector<double>& g) {
    for (std::size_t k = 0; k < step.d.size(); ++k) step.d[k] = alpha * h * direction[k];
    step.iterate.place(step.system());
    step.iterate.find_gradient(step.system());
    g = step.iterate.gradient;
    std::vector<double> by_row(g.size());
    gradient_by_rows(step.problem, step.d, by_row);
    EXPECT_LT(apart(g, by_row), 1e-12 * largest_of(g));
  };
  gradient(1.0, up);
  gradient(-1.0, down);
  StepMatrix matrix;
  matrix.assemble(step.system());
  ASSERT_TRUE(solver->factor());
  std::vector<double> x(s.model.unknowns), residual(s.model.unknowns);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = (up[k] - down[k]) / (2.0 * h);
  solver->solve(x, residual, step.system().excess_over(1e-12), linalg::BlockSolver::Residual::exact);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], direction[k], 1e-5) << k;
}

INSTANTIATE_TEST_SUITE_P(Orders, PointSpringsOrder, ::testing::Values(1, 2, 3));

// What has yielded stays, in the memory of the state, and the ledger has the work.
TEST(PointSprings, YieldsForGood) {
  simulation::Scene scene = pair_in_flight(1e7);
  scene.setup.springs.front().yield = 1e4;
  scene.setup.properties[0].velocity = {-1.0, 0.0};
  simulation::Simulator s(scene);
  s.run(0.2, 1e-4);
  const double m = 2600.0 * 2.0 / 3.0, elastic = 1e4 * 1e4 / 2e7, yielded = (0.5 * m - elastic) / 1e4;
  ASSERT_EQ(s.state.couplings.size(), 1u);
  EXPECT_NEAR(s.state.couplings.front().front(), yielded, 2e-3 * yielded);
  EXPECT_NEAR(s.state.ledger.friction, 1e4 * yielded, 2e-3 * 1e4 * yielded);
  EXPECT_LT(std::abs(s.residual()), 1e-6 * 0.5 * 2600.0);
}

// A spring ends with a block of it.
TEST(PointSprings, EndsWhereABlockIsGone) {
  simulation::Scene scene = pair_in_flight(1e7);
  scene.setup.properties[0].velocity = {-1.0, 0.0};
  simulation::Simulator s(scene);
  s.run(0.01, 1e-3);
  s.model.surface.present[1] = 0;
  s.stepper.remove_absent(s.state);
  EXPECT_EQ(s.state.support_energy, 0.0);
  s.run(1e-3, 1e-3);  // the mean with the force before
  const Vec2 before = s.velocity(0);
  s.run(0.01, 1e-3);
  EXPECT_NEAR(s.velocity(0).x, before.x, 1e-12);
}

TEST(PointSprings, RefusesEndsThatAreNoTwoBlocks) {
  const auto refused = [](Vec2 from, Vec2 to) {
    simulation::Scene scene(1e9, 30.0);
    scene.rectangle({0.0, 0.0}, 1.0, 1.0);
    scene.rectangle({2.0, 0.0}, 1.0, 1.0, 0.0, true);
    scene.rectangle({4.0, 0.0}, 1.0, 1.0, 0.0, true);
    scene.setup.springs.push_back(spring(from, to, 1e6));
    try {
      simulation::build_model(scene.setup);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({0.5, 0.5}, {2.5, 0.5}), "");
  EXPECT_THAT(refused({0.5, 0.5}, {1.5, 0.5}), ::testing::HasSubstr("spring[0].to"));
  EXPECT_THAT(refused({0.5, 0.5}, {0.7, 0.5}), ::testing::HasSubstr("another block"));
  EXPECT_THAT(refused({2.5, 0.5}, {4.5, 0.5}), ::testing::HasSubstr("a block that moves"));
}

}  // namespace
}  // namespace keyblock::dynamics
