#include "coupling/rock_column.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace keyblock::dynamics {
namespace {

RockLayer layer(double top, double density, double vs, double vp) {
  const double shear = density * vs * vs, upright = density * vp * vp;
  return {top, density, shear, upright, upright - 2.0 * shear};
}

// The integral of a Ricker wavelet of 4 Hz and 3 m/s².
double velocity(double t) {
  const double phase = std::numbers::pi * 4.0 * (t - 0.5);
  return 3.0 * (t - 0.5) * std::exp(-phase * phase);
}
double acceleration(double t) {
  const double squared = std::pow(std::numbers::pi * 4.0 * (t - 0.5), 2);
  return 3.0 * (1.0 - 2.0 * squared) * std::exp(-squared);
}

// The largest difference of the surface's velocity, against the frame, from what it should be, over 1.2 s.
double largest_error(const RockColumn& column, const Integrator& rule, Vec2 direction,
                     const std::function<Vec2(double)>& expected) {
  const double dt = 0.001;
  std::vector<double> memory(column.memory_size(), 0.0);
  const RockColumn::Place top = column.place_of(column.heights().back());
  double error = 0.0;
  for (int k = 0; k < 1200; ++k) {
    const double t = dt * (k + 1);
    column.step(memory, dt, rule, acceleration(t) * direction, memory);
    error = std::max(error, norm(column.motion(memory, top).velocity - expected(t)));
  }
  return error;
}

// What goes up in a column comes back from the ground, and leaves through a base as the rock above it.
TEST(RockColumn, LetsWavesOut) {
  const RockLayer rock = layer(40.0, 2400.0, 800.0, 1400.0);
  const RockColumn column(std::span(&rock, 1), 0.0, 40.0, rock.impedance(), 25.0);
  const Integrator rule = Integrator::generalized_alpha(0.0);
  const auto expected = [](double speed, Vec2 direction) {
    return [=](double t) { return (velocity(t - 40.0 / speed) - velocity(t)) * direction; };
  };
  EXPECT_LT(largest_error(column, rule, {1.0, 0.0}, expected(800.0, {1.0, 0.0})), 2e-4);
  EXPECT_LT(largest_error(column, rule, {0.0, 1.0}, expected(1400.0, {0.0, 1.0})), 2e-4);
}

// Of two layers, waves go back and forth in the upper one.
TEST(RockColumn, ReflectsAtAnotherRock) {
  const RockLayer rock[] = {layer(30.0, 2000.0, 250.0, 500.0), layer(10.0, 2500.0, 1500.0, 3000.0)};
  const RockColumn column(rock, 0.0, 30.0, rock[1].impedance(), 25.0);
  const double ratio = 2000.0 * 250.0 / (2500.0 * 1500.0), back = (ratio - 1.0) / (ratio + 1.0);
  const auto expected = [&](double t) {
    double sum = 0.0, share = 2.0 / (1.0 + ratio);
    for (int k = 0; k < 30; ++k, share *= back)
      sum += share * velocity(t - (2 * k + 1) * 20.0 / 250.0 - 10.0 / 1500.0);
    return Vec2{sum - velocity(t), 0.0};
  };
  EXPECT_LT(largest_error(column, Integrator::generalized_alpha(0.0), {1.0, 0.0}, expected), 2e-3);
}

// Long steps of Shi's rule lead to rest, where the weight of the rock above is carried: on a fixed base, between layers, and up to the ground.
TEST(RockColumn, CarriesWhatIsAbove) {
  const RockLayer rock[] = {layer(30.0, 2000.0, 250.0, 500.0), layer(10.0, 2500.0, 1500.0, 3000.0)};
  const RockColumn column(rock, 0.0, 30.0, std::nullopt, 25.0);
  std::vector<double> memory(column.memory_size(), 0.0);
  const Vec2 frame{0.3, -1.0};
  for (int k = 0; k < 40; ++k) column.step(memory, 100.0, Integrator::shi(0.0), frame, memory);
  for (const double y : {0.0, 3.3, 9.9, 10.1, 17.0, 29.5, 30.0}) {
    const double above = y > 10.0 ? 2000.0 * (30.0 - y) : 2000.0 * 20.0 + 2500.0 * (10.0 - y);
    const RockColumn::Stress stress = column.stress(memory, column.place_of(y));
    EXPECT_NEAR(stress.xy, -0.3 * above, 300.0) << y;
    EXPECT_NEAR(stress.yy, 1.0 * above, 1000.0) << y;
    EXPECT_NEAR(stress.xx, 0.5 * stress.yy, 1e-6 * std::abs(stress.yy)) << y;
  }
  EXPECT_EQ(column.motion(memory, column.place_of(0.0)).displacement, Vec2{});
}

TEST(RockColumn, HasLayersFromAbove) {
  const RockLayer rock[] = {layer(30.0, 2000.0, 250.0, 500.0), layer(10.0, 2500.0, 1500.0, 3000.0)};
  EXPECT_EQ(&layer_at(rock, 50.0), &rock[0]);
  EXPECT_EQ(&layer_at(rock, 10.1), &rock[0]);
  EXPECT_EQ(&layer_at(rock, 10.0), &rock[1]);
  EXPECT_EQ(&layer_at(rock, -5.0), &rock[1]);
}

}  // namespace
}  // namespace keyblock::dynamics
