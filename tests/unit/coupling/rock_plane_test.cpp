#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/rock_column.h"

namespace keyblock::dynamics {
namespace {

constexpr double density = 2500.0, young = 2e9, poisson = 0.25, gravity = 9.81, ground = 20.0;

RockLayer rock() {
  const double shear = young / (2.0 * (1.0 + poisson)),
               upright = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  return {ground, density, shear, upright, upright - 2.0 * shear};
}

/// A plane so deep, in rock under its own weight and as much across.
RockPlane plane(double depth, double friction, double dip = 0.0) {
  const double degree = std::numbers::pi / 180.0, weight = density * gravity * depth;
  return {.height = ground - depth,
          .dip = dip * degree,
          .friction = std::tan(friction * degree),
          .normal_stiffness = 20.0 * young,
          .shear_stiffness = 8.0 * young,
          .level = weight,
          .normal = weight};
}

struct Sine {
  double amplitude, frequency, cycles;
  [[nodiscard]] double mean(double from, double to) const {
    const double end = cycles / frequency, omega = 2.0 * std::numbers::pi * frequency;
    const auto integral = [&](double t) { return -std::cos(omega * std::min(t, end)) / omega; };
    return amplitude * (integral(to) - integral(from)) / (to - from);
  }
};

/// A column of 20 m on a half-space of the same rock, for 1.8 s under 3 cycles of 3 Hz along x.
std::vector<RockPlaneState> shaken(const std::vector<RockPlane>& planes, double step, double amplitude = 4.0,
                                   Sine along_y = {0.0, 1.0, 1.0},
                                   const std::vector<RockLayer>& layers = {rock()}) {
  const RockColumn column(layers, 0.0, ground, layers.back().impedance(), 25.0, {}, planes);
  const Integrator rule = Integrator::generalized_alpha(0.0);
  const Sine along_x{amplitude, 3.0, 3.0};
  std::vector<double> memory(column.memory_size(), 0.0);
  for (int k = 0; (k + 0.5) * step < 1.8; ++k) {
    const double from = k * step, to = (k + 1) * step;
    column.step(memory, step, rule, {along_x.mean(from, to), along_y.mean(from, to)}, memory);
  }
  std::vector<RockPlaneState> states;
  for (std::size_t k = 0; k < column.planes().size(); ++k) states.push_back(column.plane(memory, k));
  return states;
}

// A plane where one layer ends and the next begins is in the column, and so is one of two at the same height: the weaker one. Without it the
// numbers of planes and of their elements were others, and the step read beyond the end of its memory.
TEST(RockPlane, AtTheEndOfALayerOrOfAnotherPlane) {
  const RockPlaneState alone = shaken({plane(5.0, 10.0)}, 0.002).front();
  RockLayer lower = rock();
  lower.top = ground - 5.0;
  const std::vector<RockLayer> two{rock(), lower};
  EXPECT_NEAR(shaken({plane(5.0, 10.0)}, 0.002, 4.0, {0.0, 1.0, 1.0}, two).front().largest_slip,
              alone.largest_slip, 1e-3 * alone.largest_slip);
  const std::vector<RockPlaneState> twice = shaken({plane(5.0, 30.0), plane(5.0, 10.0)}, 0.002);
  ASSERT_EQ(twice.size(), 1U);
  EXPECT_EQ(twice.front().largest_slip, alone.largest_slip);
}

// Known: a chain of 800 masses with a Coulomb joint, explicit.
TEST(RockPlane, SlipsAsAChainOfMasses) {
  const RockPlaneState coarse = shaken({plane(5.0, 10.0)}, 0.002).front(),
                       fine = shaken({plane(5.0, 10.0)}, 0.00025).front();
  EXPECT_NEAR(coarse.largest_slip, 19.348e-3, 0.05 * 19.348e-3);
  EXPECT_NEAR(coarse.slip, -1.946e-3, 1e-3);
  EXPECT_NEAR(fine.largest_slip, 19.348e-3, 0.01 * 19.348e-3);
  EXPECT_TRUE(coarse.broken);
  EXPECT_FALSE(coarse.opened);
}

TEST(RockPlane, FrictionBoundsIt) {
  EXPECT_EQ(shaken({plane(5.0, 25.0)}, 0.002).front().largest_slip, 0.0);
  EXPECT_NEAR(shaken({plane(5.0, 15.0)}, 0.001).front().largest_slip, 6.33e-3, 0.05 * 6.33e-3);
  RockPlane bonded = plane(5.0, 10.0);
  bonded.cohesion = bonded.tension = 1e9;
  EXPECT_EQ(shaken({bonded}, 0.002).front().largest_slip, 0.0);
}

// The lower one lets less through.
TEST(RockPlane, OneShieldsAnother) {
  const auto states = shaken({plane(5.0, 10.0), plane(12.0, 10.0)}, 0.00025);
  EXPECT_NEAR(states[0].largest_slip, 18.863e-3, 0.03 * 18.863e-3);
  EXPECT_NEAR(states[1].largest_slip, 3.838e-3, 0.05 * 3.838e-3);
}

// With pressure waves that take all of the weight off it.
TEST(RockPlane, Opens) {
  const RockPlaneState state = shaken({plane(5.0, 10.0)}, 0.0005, 4.0, {12.0, 6.0, 6.0}).front();
  EXPECT_TRUE(state.opened);
  EXPECT_NEAR(state.largest_slip, 22.16e-3, 0.05 * 22.16e-3);
}

// Known: slip along the dip is about that of the level plane, and goes downhill in the end.
TEST(RockPlane, SlipsDownhill) {
  const RockPlaneState right = shaken({plane(5.0, 10.0, 10.0)}, 0.001).front(),
                       left = shaken({plane(5.0, 10.0, -10.0)}, 0.001).front();
  EXPECT_NEAR(right.largest_slip, 17.7e-3, 0.08 * 17.7e-3);
  EXPECT_GT(right.slip, 5e-3);
  EXPECT_LT(left.slip, 0.0);
}

// A static stage leaves it where it is, and the next waves add to that.
TEST(RockPlane, Rests) {
  const RockLayer layer = rock();
  const std::vector<RockPlane> planes{plane(5.0, 10.0)};
  const RockColumn column(std::span(&layer, 1), 0.0, ground, layer.impedance(), 25.0, {}, planes);
  std::vector<double> memory(column.memory_size(), 0.0), moved(2 * column.heights().size(), 0.0);
  for (int k = 0; k < 100; ++k)
    column.step(memory, 0.002, Integrator::generalized_alpha(0.0), {4.0, 0.0}, memory);
  const RockPlaneState before = column.plane(memory, 0);
  ASSERT_NE(before.slip, 0.0);
  const double top = column.displacements(memory).back();
  column.rest(memory, moved);
  const RockPlaneState after = column.plane(memory, 0);
  EXPECT_EQ(after.slip, before.slip);
  EXPECT_EQ(after.shear, 0.0);
  EXPECT_EQ(moved.back(), top);
  EXPECT_EQ(column.displacements(memory).front(), 0.0);
}

}  // namespace
}  // namespace keyblock::dynamics
