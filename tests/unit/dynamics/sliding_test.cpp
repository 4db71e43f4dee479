#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../scene.h"

namespace keyblock::simulation {
namespace {

const std::vector<double> all_steps{0.02, 0.01, 0.005, 0.002, 0.001, 0.0005, 0.0001};

/// A block of 1 m on a long incline of angle α, that runs down to the left. The formulas are for rigid blocks: set down on
/// the incline at once, a soft block swings for a few milliseconds and gains about g sin α / ω of velocity.
Scene incline(double alpha, double phi, double length = 20.0, double young = 5e10) {
  Scene scene(young, phi);
  scene.rectangle({-length * std::cos(alpha * degree), -length * std::sin(alpha * degree)}, length + 4.0,
                  -1.0, alpha, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5, alpha);
  return scene;
}

double slid(const Simulator& s, Vec2 from, double alpha) {
  const Vec2 down{-std::cos(alpha * degree), -std::sin(alpha * degree)};
  return dot(s.centroid(1) - from, down);
}

TEST(FreeFall, IsExactForAnyStep) {
  for (int order : {1, 2, 4}) {
    for (double dt : {0.1, 0.02, 0.001}) {
      Scene scene(1e9, 0.0);
      scene.rectangle({0, 0}, 1.0, 0.5, 20.0, false, order);
      scene.setup.properties[0].velocity = {3.0, 20.0};
      Simulator s(scene);
      const Vec2 from = s.centroid(0);
      s.run(10.0, dt);
      const Vec2 expected = from + Vec2{30.0, 200.0 - 0.5 * g * 100.0};
      EXPECT_LT(norm(s.centroid(0) - expected) / norm(expected), 1e-10) << order << ' ' << dt;
      const block::Stress stress =
          s.model.blocks[0].elasticity.mean_cauchy(&s.state.position[s.model.blocks[0].first]);
      EXPECT_LT(std::abs(stress.xx) / 1e9, 1e-12);
    }
  }
}

// Its weight and the friction that this gives come with the first steps, and are not to break the bond before they are all there.
TEST(Bond, HoldsOnAnInclineWhatCoulombSaysForAnyStep) {
  for (const double dt : {0.01, 0.002, 0.0005}) {
    for (const auto& [cohesion, holds] : {std::pair{2.5e3, false}, {3.5e3, true}}) {
      Scene scene(1e9, 30.0, 2000.0);
      scene.rectangle({-10.0, -10.0}, 20.0, -1.0, 45.0, true);
      scene.rectangle({0.0, 0.0}, 4.0, 0.5, 45.0);
      scene.setup.joints.standard.cohesion = cohesion;
      scene.setup.time_step = dt;
      scene.setup.stages = {stage("settle", record::StageKind::settle),
                            stage("rest", record::StageKind::rest, 0.1)};
      scene.setup.histories.push_back({"block", "b1", {1.0, 1.5}});
      LastHistory observer;
      run(scene.setup, {}, observer);
      EXPECT_EQ(norm({observer.last.points[0].ux, observer.last.points[0].uy}) < 1e-4, holds)
          << dt << ' ' << cohesion;
    }
  }
}

// What was the border of a domain is rock to blocks that stand on it.
TEST(Sliding, OuterEdgesOfCutRockHaveTheLawOfJoints) {
  for (const bool cut : {false, true}) {
    Scene scene = incline(20.0, 30.0);
    if (cut) {
      for (cutting::EdgeLabel& label : scene.setup.system.blocks[0].labels[0])
        label.kind = cutting::EdgeKind::domain;
    }
    Simulator s(scene);
    const Vec2 from = s.centroid(1);
    s.run(0.2, 0.002);
    EXPECT_LT(slid(s, from, 20.0), 1e-4) << cut;
  }
}

class Incline : public ::testing::TestWithParam<double> {};

TEST_P(Incline, SlidesAsCoulombSays) {
  struct Case {
    double alpha, phi, expected;
  };
  for (const auto& [alpha, phi, expected] : {Case{28, 15, 1.142308},
                                             {30, 0, 2.45250},
                                             {30, 10, 1.70349},
                                             {30, 20, 0.906407},
                                             {30, 25, 0.471693},
                                             {45, 20, 2.205979}}) {
    Simulator s(incline(alpha, phi));
    const Vec2 from = s.centroid(1);
    s.run(1.0, GetParam());
    EXPECT_NEAR(slid(s, from, alpha) / expected, 1.0, 1e-3) << alpha << ' ' << phi;
    EXPECT_EQ(s.unconverged, 0);
    EXPECT_LT(std::abs(s.residual()),
              0.01 * std::abs(s.state.ledger.friction + dynamics::kinetic_energy(s.model, s.state)));
  }
}

TEST_P(Incline, Sticks) {
  for (double phi : {31.0, 35.0}) {
    Simulator s(incline(30.0, phi));
    const Vec2 from = s.centroid(1);
    s.run(1.0, GetParam());
    EXPECT_LT(std::abs(slid(s, from, 30.0)), 1e-4) << phi;
    EXPECT_EQ(s.unconverged, 0);
  }
}

TEST_P(Incline, StackOfNineKeepsItsPlace) {
  Scene scene(1e9, 35.0);
  scene.rectangle({-1.0, -1.0}, 6.0, 1.0, 0.0, true);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) scene.rectangle({1.0 * column, 0.5 * row}, 1.0, 0.5);
  }
  Simulator s(scene);
  s.run(1.0, GetParam());
  for (int b = 1; b < 10; ++b) {
    const Vec2 start = keyblock::centroid(scene.setup.system.blocks[static_cast<std::size_t>(b)].polygon);
    EXPECT_LT(norm(s.centroid(b) - start), 1e-4) << b;
  }
  EXPECT_EQ(s.unconverged, 0);
}

INSTANTIATE_TEST_SUITE_P(Steps, Incline, ::testing::ValuesIn(all_steps));

/// What a block has slid down 45° with φ = 30° in 1 s while it was shaken across, over what the impulse of the normal force allows: all
/// that friction does is tan φ times what the normal force does, and that is known from where the block is. Steps are as long as these in
/// turn.
double slid_by_impulse(const std::vector<double>& steps) {
  constexpr double alpha = 45.0, phi = 30.0, amplitude = 3.0;
  const Vec2 out{-std::sin(alpha * degree), std::cos(alpha * degree)};
  const Sine ground(amplitude * out, 5.0);
  Simulator s(incline(alpha, phi));
  const Vec2 from = s.centroid(1);
  for (std::size_t k = 0; s.state.time < 1.0 - 1e-9; ++k)
    s.run(steps[k % steps.size()], steps[k % steps.size()], &ground);
  const double friction = std::tan(phi * degree), t = s.state.time,
               across = amplitude / ground.omega() * (t - std::sin(ground.omega() * t) / ground.omega());
  const double expected = 0.5 * g * (std::sin(alpha * degree) - std::cos(alpha * degree) * friction) * t * t -
                          friction * (across + dot(s.centroid(1) - from, out));
  EXPECT_EQ(s.unconverged, 0);
  return slid(s, from, alpha) / expected;
}

TEST_P(Incline, LosesNoFrictionWhileTheNormalForceSwings) {
  EXPECT_NEAR(slid_by_impulse({GetParam()}), 1.0, 1e-4);
}

// What a contact owes is an impulse: in a shorter step it is a larger force.
TEST(Sliding, LosesNoFrictionInStepsOfOtherLengths) {
  EXPECT_NEAR(slid_by_impulse({0.005, 0.00125, 0.00125, 0.005, 0.00125}), 1.0, 1e-4);
}

// Steps do not hit the moment at which a block comes to rest. It neither goes on nor is what is left of its velocity sent to and fro.
TEST_P(Incline, ComesToRestWithoutARest) {
  const double dt = GetParam(), speed = 1.0, deceleration = g * std::tan(20.0 * degree);
  for (const double theta : {1.0, 0.5}) {
    Scene scene = incline(0.0, 20.0);
    scene.setup.properties.back().velocity = {-speed, 0.0};
    scene.setup.solver.theta = theta;
    Simulator s(scene);
    const Vec2 from = s.centroid(1);
    s.run(0.4, dt);
    const double lag =
        0.5 * (1.0 - theta) / (1.0 + theta) * speed * dt;  // of the rule, under constant acceleration
    EXPECT_NEAR(slid(s, from, 0.0), 0.5 * speed * speed / deceleration - lag,
                0.5 * deceleration * dt * dt + 1e-5)
        << theta;
    EXPECT_LT(norm(s.velocity(1)), 0.01 * deceleration * dt + 1e-6) << theta;
  }
}

// Over joints between blocks side by side, by more than an end zone in a step: the corner in front comes to lie a few micrometres behind
// the side of the next block, at the end of some steps, as it lies behind its face.
TEST(Sliding, FastOverJointsIsAsOnOneFace) {
  Scene scene(5e9, 20.0, 2500.0);
  const double piece = 0.37, speed = 3.0;
  for (double x = -2.0; x < 4.0; x += piece) scene.rectangle({x, -1.0}, piece, 1.0, 0.0, true);
  const int block = scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  scene.setup.properties.back().velocity = {speed, 0.0};
  Simulator s(scene);
  const Vec2 from = s.centroid(block);
  s.run(1.0, 0.001);
  const double friction = std::tan(20.0 * degree);
  EXPECT_NEAR((s.centroid(block).x - from.x) / (0.5 * speed * speed / (g * friction)), 1.0, 1e-3);
  EXPECT_LT(std::abs(s.state.ledger.numerical), 1e-3 * s.initial_energy);
}

}  // namespace
}  // namespace keyblock::simulation
