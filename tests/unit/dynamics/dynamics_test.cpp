#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include "../scene.h"
#include "core/error.h"

namespace keyblock::simulation {
namespace {

/// Displacements of a mass on a spring with ω Δt = omega_dt, after each of `steps` steps, in units of Δt.
std::vector<double> on_a_spring(dynamics::TimeIntegration integrator, double radius, double omega_dt,
                                int steps) {
  const double mass = 2600.0, dt = 0.001;
  Scene scene(1e13, 0.0);
  scene.setup.gravity = {0.0, 0.0};
  scene.setup.solver.integrator = integrator;
  scene.setup.solver.spectral_radius = radius;
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.setup.properties[0].velocity = {1.0, 0.0};
  loading::Support support;
  support.block = "b0";
  support.points = {{0.5, 0.5}};
  support.along_y = false;
  support.stiffness = mass * omega_dt * omega_dt / (dt * dt);
  scene.setup.supports.push_back(support);
  Simulator s(scene);
  std::vector<double> x;
  for (int k = 0; k < steps; ++k) {
    s.run(dt, dt);
    x.push_back((s.centroid(0).x - 0.5) / dt);
  }
  return x;
}

// A block on a spring to the ground: Shi's scheme loses 1 − 1/√(1 + Ω²/2) of the amplitude per step, Ω = ωΔt.
TEST(TimeIntegration, SpectralRadiusOnASpring) {
  for (const auto& [omega_dt, expected] :
       {std::pair{0.1, 0.99750934}, {0.5, 0.94280904}, {1.0, 0.81649658}, {2.0, 0.57735027}}) {
    const std::vector<double> x = on_a_spring(dynamics::TimeIntegration::shi, 1.0, omega_dt, 4);
    // x_{n+1} = t x_n − d x_{n−1}; d = ρ².
    const double d = (x[1] * x[3] - x[2] * x[2]) / (x[0] * x[2] - x[1] * x[1]);
    EXPECT_NEAR(std::sqrt(d), expected, 1e-8) << omega_dt;
  }
}

/// Amplification matrix of (x, Δt v, Δt² a) on a spring, from the formulas of Chung & Hulbert (1993).
Eigen::Matrix3d amplification(double alpha_m, double alpha_f, double omega_dt) {
  const double gamma = 0.5 - alpha_m + alpha_f, beta = 0.25 * std::pow(1.0 - alpha_m + alpha_f, 2),
               k = omega_dt * omega_dt;
  Eigen::Matrix3d end, start;  // end · (state at the end) = start · (state at the start)
  end << 1.0, 0.0, -beta, 0.0, 1.0, -gamma, (1.0 - alpha_f) * k, 0.0, 1.0 - alpha_m;
  start << 1.0, 1.0, 0.5 - beta, 0.0, 1.0, 1.0 - gamma, -alpha_f * k, 0.0, -alpha_m;
  return end.inverse() * start;
}

// Steps on a spring obey the recurrence that the rule's amplification matrix A has by the theorem of Cayley and Hamilton. Its
// spectral radius is then the rule's; at high frequency it is the one asked for.
TEST(TimeIntegration, AverageAccelerationAndGeneralizedAlphaHaveTheirSpectralRadius) {
  using dynamics::TimeIntegration;
  for (const double radius : {-1.0, 1.0, 0.8, 0.5, 0.0}) {  // −1: average acceleration
    const bool average = radius < 0.0;
    const TimeIntegration rule =
        average ? TimeIntegration::average_acceleration : TimeIntegration::generalized_alpha;
    const double alpha_m = average ? 0.0 : (2.0 * radius - 1.0) / (radius + 1.0),
                 alpha_f = average ? 0.0 : radius / (radius + 1.0);
    for (const double omega_dt : {0.1, 1.0, 10.0}) {
      const std::vector<double> x = on_a_spring(rule, radius, omega_dt, 12);
      const Eigen::Matrix3d a = amplification(alpha_m, alpha_f, omega_dt);
      const double minors = 0.5 * (a.trace() * a.trace() - (a * a).trace());
      double largest = 0.0;
      for (std::size_t k = 1; k + 3 < x.size(); ++k) {
        const double next = a.trace() * x[k + 2] - minors * x[k + 1] + a.determinant() * x[k];
        EXPECT_NEAR(x[k + 3], next, 1e-9) << radius << " " << omega_dt << " " << k;
        largest = std::max(largest, std::abs(x[k + 3]));
      }
      EXPECT_GT(largest, radius == 0.0 ? 0.0 : 1e-4) << radius << " " << omega_dt;
    }
    const double at_infinity = amplification(alpha_m, alpha_f, 1e6).eigenvalues().cwiseAbs().maxCoeff();
    EXPECT_NEAR(at_infinity, average ? 1.0 : radius, 1e-3);
  }
}

// The linear update of classic DDA multiplies the area by 1 + r² per step of rotation r; this one keeps it.
TEST(Rotation, FullTurnKeepsAreaAndStress) {
  for (int order : {1, 2, 3}) {
    Scene scene(1e9, 0.0);
    scene.setup.gravity = {0.0, 0.0};
    scene.rectangle({0.0, 0.0}, 1.0, 0.6, 0.0, false, order);
    scene.setup.properties[0].spin = 2.0 * std::numbers::pi;
    scene.setup.solver.rock_damping = 0.0;
    for (int steps : {100, 1000}) {
      Simulator s(scene);
      const dynamics::Block& block = s.model.blocks[0];
      const double before = block.pose.area(&s.state.position[block.first]);
      const double kinetic = dynamics::kinetic_energy(s.model, s.state);
      s.run(1.0, 1.0 / steps);
      EXPECT_NEAR(block.pose.area(&s.state.position[block.first]) / before, 1.0, 1e-9)
          << order << ' ' << steps;
      EXPECT_NEAR(dynamics::kinetic_energy(s.model, s.state) / kinetic, 1.0, 1e-9);
    }
  }
}

// Goodman & Seed: an incline shaken along a sine; the rigid block slides downhill once per cycle.
TEST(ShakenIncline, SlidesAsNewmarkSays) {
  const double alpha = 20.0, phi = 30.0, amplitude = 0.5 * g, omega = 2.0 * std::numbers::pi;
  Scene scene(5e10, phi);
  scene.rectangle({-10.0 * std::cos(alpha * degree), -10.0 * std::sin(alpha * degree)}, 14.0, -1.0, alpha,
                  true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5, alpha);
  // Sliding downhill while C0 + C1 sin ωt has pushed it, from θ on; 0.313620 m per cycle.
  for (double dt : {0.005, 0.002, 0.001}) {
    Simulator s(scene);
    const Vec2 from = s.centroid(1);
    // The incline runs down to the left; a ground acceleration to the right throws the block to the left.
    const Sine ground({amplitude, 0.0}, 1.0);
    s.run(3.0, dt, &ground);
    const Vec2 down{-std::cos(alpha * degree), -std::sin(alpha * degree)};
    EXPECT_NEAR(dot(s.centroid(1) - from, down) / (3.0 * 0.313620), 1.0, 5e-3) << dt;
    EXPECT_EQ(s.unconverged, 0);
  }
  (void)omega;
}

TEST(Column, ContactForceAtDepthIsTheWeightAbove) {
  Scene scene(1e9, 30.0);
  scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
  for (int k = 0; k < 5; ++k) scene.rectangle({0.0, 1.0 * k}, 1.0, 1.0);
  Simulator s(scene);
  const std::vector<double> scale(6, 1.0);
  for (int k = 0; k < 400; ++k) s.stepper.relax(s.state, {.step = 0.05, .inertia_scale = scale});
  const std::vector<dynamics::ContactForce> forces = s.stepper.forces();
  std::vector<double> force(6, 0.0);
  for (std::size_t c = 0; c < s.stepper.contacts().size(); ++c) {
    const contact::Contact& contact = s.stepper.contacts()[c];
    const int upper = std::max(contact.block_a, contact.block_b);
    force[static_cast<std::size_t>(upper)] += forces[c].normal;
  }
  for (int k = 1; k <= 5; ++k)
    EXPECT_NEAR(force[static_cast<std::size_t>(k)] / ((6 - k) * 2600.0 * g), 1.0, 1e-6) << k;
}

TEST(Bond, CohesionHoldsAndBreaksOnce) {
  // A block on a vertical wall face holds by c·L alone until its weight exceeds it.
  const double weight = 2600.0 * g;
  for (const auto& [cohesion, holds] : {std::pair{1.5 * weight, true}, {0.9 * weight, false}}) {
    Scene scene(1e9, 0.0);
    scene.setup.joints.standard.cohesion = cohesion;
    scene.setup.joints.standard.tension = 1e9;
    scene.rectangle({-1.0, -1.0}, 1.0, 3.0, 0.0, true);
    scene.rectangle({0.0, 0.0}, 1.0, 1.0);
    Simulator s(scene);
    const std::vector<double> scale(2, 1.0);
    for (int k = 0; k < 300; ++k) s.stepper.relax(s.state, {.step = 0.002, .inertia_scale = scale});
    s.run(0.5, 0.002);
    const double fallen = 0.5 - s.centroid(1).y;
    if (holds) {
      EXPECT_LT(std::abs(fallen), 1e-4);
    } else {
      EXPECT_GT(fallen, 0.5);
    }
  }
}

// Outlines may miss each other by a little where they are bonded: that is how they are, and pulls at nothing.
TEST(Bond, DoesNotPullItsJointShut) {
  Scene scene(1e9, 30.0);
  scene.setup.gravity = {};
  scene.setup.joints.standard.cohesion = scene.setup.joints.standard.tension = 1e9;
  scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
  const int block = scene.rectangle({0.0, 5e-5}, 1.0, 1.0);
  Simulator s(scene);
  ASSERT_TRUE(
      std::ranges::any_of(s.stepper.find_contacts(s.state), [](const auto& c) { return c.memory.bonded; }));
  const Vec2 before = s.centroid(block);
  s.run(0.02, 0.002);
  EXPECT_NEAR(norm(s.centroid(block) - before), 0.0, 1e-12);
}

TEST(Threads, GiveTheSameBits) {
  const auto run = [](int threads, int rows, int columns, double duration) {
    Scene scene(1e9, 35.0);
    scene.rectangle({-2.0, -1.0}, columns + 4.0, 1.0, 0.0, true);
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column)
        scene.rectangle({1.0 * column + 0.5 * (row % 2), 0.5 * row}, 1.0, 0.5);
    }
    Simulator s(scene, threads);
    const Sine ground({0.6 * g, 0.0}, 2.0);
    s.run(duration, 0.002, &ground);
    EXPECT_EQ(s.unconverged, 0);
    return std::tuple(s.state.position, s.state.ledger.numerical, s.state.ledger.friction);
  };
  const auto small = run(1, 6, 16, 0.4),
             large = run(1, 60, 70, 0.016);  // all loops of the large one are worth threads
  for (const int threads : {2, 3}) {
    EXPECT_EQ(run(threads, 6, 16, 0.4), small);
    EXPECT_EQ(run(threads, 60, 70, 0.016), large);
  }
}

TEST(LinearSolver, DirectOracleGivesTheSameMotion) {
  const auto run = [](dynamics::LinearSolver linear) {
    Scene scene(1e9, 35.0);
    scene.setup.solver.linear = linear;
    settle_bounds(scene.setup.solver);
    scene.rectangle({-2.0, -1.0}, 12.0, 1.0, 0.0, true);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column)
        scene.rectangle({1.0 * column + 0.25 * (row % 2), 0.5 * row}, 1.0, 0.5, 0.0, false, 1 + row % 2);
    }
    Simulator s(scene);
    const Sine ground({0.3 * g, 0.0}, 2.0);
    s.run(0.2, 0.002, &ground);
    return s.state.position;
  };
  const std::vector<double> block = run(dynamics::LinearSolver::block),
                            direct = run(dynamics::LinearSolver::direct);
  for (std::size_t k = 0; k < block.size(); ++k) EXPECT_NEAR(block[k], direct[k], 1e-9);
}

// A ground that shakes by what is no number: the run ends there, and does not go on with positions that are none.
TEST(Step, EndsTheRunWhenABlockHasNoPosition) {
  for (const auto linear : {dynamics::LinearSolver::block, dynamics::LinearSolver::iterative}) {
    Scene scene(1e9, 35.0);
    scene.setup.solver.linear = linear;
    scene.rectangle({-2.0, -1.0}, 6.0, 1.0, 0.0, true);
    scene.rectangle({0.0, 0.0}, 1.0, 0.5);
    scene.rectangle({0.0, 0.5}, 1.0, 0.5);
    Simulator s(scene);
    s.run(0.002, 0.002);
    const Sine ground({std::numeric_limits<double>::quiet_NaN(), 0.0}, 2.0);
    EXPECT_THROW(s.run(0.002, 0.002, &ground), RunError);
  }
}

// Large enough for factors in single precision, which leave no more than tolerances do; bricks slide.
TEST(LinearSolver, FactorsOfFewerDigitsGiveTheSameMotion) {
  const auto run = [](dynamics::LinearSolver linear) {
    constexpr int rows = 12, columns = 20;
    Scene scene(1e9, 20.0);
    scene.setup.solver.linear = linear;
    settle_bounds(scene.setup.solver);
    scene.rectangle({-2.0, -1.0}, columns + 4.0, 1.0, 0.0, true);
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column)
        scene.rectangle({1.0 * column + 0.25 * (row % 2), 0.5 * row}, 1.0, 0.5, 0.0, false, 2);
    }
    Simulator s(scene);
    const Sine ground({2.0 * g, 0.0}, 10.0);
    s.run(0.02, 0.002, &ground);
    EXPECT_EQ(s.unconverged, 0);
    return std::pair(s.state.position, s.state.velocity);
  };
  const auto [position, velocity] = run(dynamics::LinearSolver::block);
  const auto [expected, expected_velocity] = run(dynamics::LinearSolver::direct);
  EXPECT_GT(*std::ranges::max_element(velocity), 0.01);
  for (std::size_t k = 0; k < position.size(); ++k) {
    EXPECT_NEAR(position[k], expected[k], 1e-9) << k;
    EXPECT_NEAR(velocity[k], expected_velocity[k], 1e-6) << k;
  }
}

// A long wall that is struck at one end: what is out of balance there is taken off near there. Edges of order 2 are bent.
TEST(LinearSolver, SystemsNearFewBlocksGiveTheSameMotion) {
  const auto run = [](dynamics::LinearSolver linear, int order) {
    constexpr int rows = 3, columns = 60;
    Scene scene(1e9, 35.0);
    scene.setup.solver.linear = linear;
    scene.setup.solver.tolerance *= 1e-3;
    settle_bounds(scene.setup.solver);
    scene.rectangle({-2.0, -1.0}, columns + 4.0, 1.0, 0.0, true);
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column)
        scene.rectangle({1.0 * column + 0.5 * (row % 2), 0.5 * row}, 1.0, 0.5, 0.0, false, order);
    }
    const int stone = scene.rectangle({2.0, 1.505}, 0.3, 0.2, 20.0);
    scene.setup.properties[static_cast<std::size_t>(stone)].velocity = {0.5, -3.0};
    Simulator s(scene);
    const Sine ground({0.2 * g, 0.0}, 2.0);
    s.run(0.04, 0.002, &ground);
    EXPECT_EQ(s.unconverged, 0);
    return s.state.position;
  };
  for (const int order : {1, 2}) {
    const auto position = run(dynamics::LinearSolver::iterative, order),
               expected = run(dynamics::LinearSolver::direct, order);
    for (std::size_t k = 0; k < position.size(); ++k) EXPECT_NEAR(position[k], expected[k], 1e-9) << k;
  }
}

// A wall that is shaken gently, and a stone that spins through the air until it strikes it, where contacts come and go: with the
// factors and matrices of earlier steps the motion is that of those made in every step.
TEST(LinearSolver, KeptFactorsGiveTheSameMotion) {
  constexpr int steps = 150;
  struct Orders {
    int even_rows, odd_rows;
  };
  const auto run = [](dynamics::LinearSolver linear, Orders orders, bool stone, bool keep) {
    Scene scene(1e9, 35.0);
    scene.setup.solver.linear = linear;
    scene.setup.solver.tolerance *= 0.01;
    settle_bounds(scene.setup.solver);
    scene.rectangle({-2.0, -1.0}, 12.0, 1.0, 0.0, true);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column)
        scene.rectangle({1.0 * column + 0.25 * (row % 2), 0.5 * row}, 1.0, 0.5, 0.0, false,
                        row % 2 == 0 ? orders.even_rows : orders.odd_rows);
    }
    if (stone) {
      const int block = scene.rectangle({2.0, 1.9}, 0.3, 0.2, 20.0);
      scene.setup.properties[static_cast<std::size_t>(block)].spin = 3.0;
    }
    Simulator s(scene);
    const Sine ground({0.05 * g, 0.0}, 2.0);
    for (int k = 0; k < steps; ++k) {
      if (!keep) s.stepper.forget_history();
      s.run(0.002, 0.002, &ground);
    }
    EXPECT_EQ(s.unconverged, 0);
    return std::pair(s.state.position, s.profile[Phase::factorization].count);
  };
  for (const Orders orders : {Orders{1, 1}, Orders{2, 2}, Orders{1, 2}}) {
    for (const bool stone : {false, true}) {
      for (const auto linear : {dynamics::LinearSolver::block, dynamics::LinearSolver::iterative}) {
        const auto [made, many] = run(linear, orders, stone, false);
        const auto [kept, few] = run(linear, orders, stone, true);
        EXPECT_GE(many, steps);
        // What springs change of a matrix for conjugate residuals counts as well; the last bits of corners that meet decide how often.
        if (linear == dynamics::LinearSolver::block) {
          EXPECT_LT(few, 2 * many / 3);
        } else if (!stone) {
          EXPECT_LT(few, 4 * many / 5);
        }
        for (std::size_t k = 0; k < made.size(); ++k) EXPECT_NEAR(kept[k], made[k], 1e-8) << k;
      }
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
