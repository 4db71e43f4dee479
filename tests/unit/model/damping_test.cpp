#include "model/damping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/rayleigh_damping.h"

namespace keyblock::dynamics {
namespace {

// Shi's rule: |λ|² = 1/(1 + Ω²/2), and ωΔt/4 for small steps. The others: figures of an independent eigenvalue computation.
TEST(NumericalDamping, IsThatOfEachRule) {
  const Integrator shi = Integrator::shi(1.0);
  EXPECT_NEAR(numerical_damping(shi, 1e-4, 1.0), std::numbers::pi * 0.5e-4, 1e-9);
  EXPECT_NEAR(numerical_damping(shi, 0.002, 3.0), 0.009422, 1e-6);
  EXPECT_NEAR(numerical_damping(shi, 0.002, 30.0), 0.092100, 1e-6);
  EXPECT_NEAR(numerical_damping(Integrator::shi(0.0), 1e-4, 1.0), std::numbers::pi * 1e-4, 1e-9);
  const Integrator alpha = Integrator::generalized_alpha(0.0);
  EXPECT_NEAR(numerical_damping(alpha, 0.002, 3.0), 0.00003, 0.5e-5);
  EXPECT_NEAR(numerical_damping(alpha, 0.002, 10.0), 0.0009, 0.5e-4);
  EXPECT_NEAR(numerical_damping(alpha, 0.002, 30.0), 0.018, 0.5e-3);
  EXPECT_NEAR(numerical_damping(Integrator::generalized_alpha(0.3), 0.002, 30.0), 0.0036, 0.5e-4);
  for (const double frequency : {0.01, 1.0, 30.0, 200.0}) {
    EXPECT_NEAR(numerical_damping(Integrator::average_acceleration(), 0.002, frequency), 0.0, 1e-9);
    EXPECT_NEAR(numerical_damping(Integrator::generalized_alpha(1.0), 0.002, frequency), 0.0, 1e-9);
  }
}

TEST(NumericalDamping, IsAShareOfCriticalForAnyStep) {
  for (const Integrator& rule : {Integrator::shi(1.0), Integrator::shi(0.3), Integrator::shi(0.0),
                                 Integrator::generalized_alpha(0.0), Integrator::generalized_alpha(0.8)}) {
    for (double step = 1e-5; step < 1e3; step *= 1.7) {
      const double ratio = numerical_damping(rule, step, 1.0);
      EXPECT_GE(ratio, 0.0) << step;
      EXPECT_LE(ratio, 1.0) << step;
    }
  }
}

// Shi's rule damps springs between points by Ω³/16 where it resolves their swing, with Ω = ω Δt. Figures of an independent eigenvalue computation.
TEST(NumericalDamping, OfSpringsIsOfThirdOrder) {
  const Integrator shi = Integrator::shi(1.0);
  for (const auto& [frequency, ratio] : {std::pair{3.0, 3.346696e-6},
                                         {9.0, 8.993450e-5},
                                         {20.0, 9.666319e-4},
                                         {60.0, 2.147645e-2},
                                         {100.0, 7.147395e-2}})
    EXPECT_NEAR(numerical_damping_of_spring(shi, 0.002, frequency) / ratio, 1.0, 1e-4) << frequency;
  for (const Integrator& rule : {Integrator::generalized_alpha(0.0), Integrator::generalized_alpha(0.8),
                                 Integrator::average_acceleration()})
    EXPECT_EQ(numerical_damping_of_spring(rule, 0.002, 20.0), numerical_damping(rule, 0.002, 20.0));
}

TEST(RayleighDamping, HasItsRatioAtItsFrequency) {
  for (const DampingKind kind : {DampingKind::stiffness, DampingKind::rayleigh, DampingKind::mass})
    EXPECT_NEAR((RayleighDamping{0.05, 3.0, kind}).ratio_at(3.0), 0.05, 1e-15);
  const RayleighDamping both{0.05, 3.0, DampingKind::rayleigh};
  EXPECT_NEAR(both.ratio_at(1.0), 0.08333, 1e-5);
  EXPECT_NEAR(both.ratio_at(10.0), 0.09083, 1e-5);
  EXPECT_NEAR((RayleighDamping{0.05, 3.0, DampingKind::stiffness}).ratio_at(6.0), 0.1, 1e-15);
  EXPECT_NEAR((RayleighDamping{0.05, 3.0, DampingKind::mass}).ratio_at(6.0), 0.025, 1e-15);
  EXPECT_EQ((RayleighDamping{0.05, 3.0, DampingKind::mass}).stiffness_time(), 0.0);
}

}  // namespace
}  // namespace keyblock::dynamics
