#include "loading/bolt.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyblock::loading {
namespace {

/// A bolt, and its pull-out where the grout slips along no, a quarter, half and three quarters of it: N and m. Independent solution of the
/// differential equation of the bar.
struct PullOut {
  const char* name;
  double bar, grout_stiffness, grout_strength, length;  ///< N, N/m², N/m, m
  double force[4], way[4];
};
constexpr PullOut pull_outs[] = {
    {"rebar",
     1.03084e8,
     1e10,
     7e5,
     1.5,
     {71071.0, 333571.0, 596071.0, 858483.0},
     {0.0700e-3, 0.80601e-3, 2.49695e-3, 5.14186e-3}},
    {"cable",
     2.8e7,
     5e8,
     1.75e5,
     3.0,
     {41413.0, 172663.0, 303912.0, 435017.0},
     {0.3500e-3, 3.21708e-3, 9.59977e-3, 19.48637e-3}},
    {"glass fibre",
     1.7106e7,
     1e9,
     1.2e5,
     2.0,
     {15695.0, 75695.0, 135695.0, 195680.0},
     {0.1200e-3, 1.45564e-3, 4.54505e-3, 9.38692e-3}},
};

Bolt bolt_of(const PullOut& of) {
  Bolt bolt;
  bolt.area = of.bar / bolt.young;
  bolt.grout_stiffness = of.grout_stiffness;
  bolt.grout_strength = of.grout_strength;
  return bolt;
}

TEST(Bolt, IsPulledOutAsItsDifferentialEquationSays) {
  for (const PullOut& of : pull_outs) {
    const Bolt bolt = bolt_of(of);
    const BoltSide side(bolt, 0.0, of.length, false);
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(side.displacement(of.force[k]) / of.way[k], 1.0, 2e-5) << of.name << " " << k;
    EXPECT_DOUBLE_EQ(side.capacity(), of.grout_strength * of.length);
    // Pulled out at last, all of it slips.
    EXPECT_NEAR(
        side.displacement(side.capacity()),
        of.grout_strength / of.grout_stiffness + 0.5 * of.grout_strength * of.length * of.length / of.bar,
        1e-9);
  }
}

// A joint that opens across a bolt which is grouted on both sides: it yields when both have come out by half of the opening.
TEST(Bolt, YieldsWhenAJointHasOpened) {
  const auto opening = [](const PullOut& of, double yield) {
    Bolt bolt = bolt_of(of);
    bolt.yield = yield;
    const BoltSide side(bolt, 0.0, of.length, false);
    const BoltAtJoint joint = bolt_at_joint(bolt, side, side);
    EXPECT_EQ(joint.capacity, yield);
    return yield / joint.stiffness;
  };
  EXPECT_NEAR(opening(pull_outs[0], 250e3), 0.9361e-3, 1e-7);
  EXPECT_NEAR(opening(pull_outs[1], 240e3), 12.105e-3, 1e-6);
}

TEST(Bolt, ShorterSideIsPulledOut) {
  Bolt bolt = bolt_of(pull_outs[0]);
  bolt.yield = 250e3;
  const BoltSide rest(bolt, 0.0, 1.5, false), end(bolt, 0.0, 0.1, false), plated(bolt, 0.0, 0.1, true),
      free(bolt, 0.3, 0.0, false);
  EXPECT_DOUBLE_EQ(bolt_at_joint(bolt, end, rest).capacity, 70e3);
  EXPECT_DOUBLE_EQ(bolt_at_joint(bolt, plated, rest).capacity, 250e3);
  EXPECT_EQ(bolt_at_joint(bolt, free, rest).capacity, 0.0);
}

// A plate holds the end of the bar: a short grouted length is as stiff as the bar to the plate and the grout beside it, a long one as without.
TEST(Bolt, PlateHoldsTheEnd) {
  const Bolt bolt = bolt_of(pull_outs[0]);
  const double force = 1e3, length = 0.02;
  const BoltSide plated(bolt, 0.0, length, true), plate_alone(bolt, length, 0.0, true);
  EXPECT_NEAR(plated.displacement(force), force * length / bolt.bar(), 0.02 * force * length / bolt.bar());
  EXPECT_DOUBLE_EQ(plate_alone.displacement(force), force * length / bolt.bar());
  EXPECT_NEAR(BoltSide(bolt, 0.0, 1.5, true).displacement(force),
              BoltSide(bolt, 0.0, 1.5, false).displacement(force), 1e-12);
}

// What never slips is elastic at any force; free length is in series.
TEST(Bolt, FreeLengthIsInSeries) {
  Bolt bolt = bolt_of(pull_outs[1]);
  bolt.grout_strength.reset();
  const BoltSide side(bolt, 0.5, 3.0, false);
  const double alpha = std::sqrt(bolt.grout_stiffness / bolt.bar());
  for (const double force : {1.0, 1e6})
    EXPECT_NEAR(side.displacement(force) / force,
                1.0 / (bolt.bar() * alpha * std::tanh(3.0 * alpha)) + 0.5 / bolt.bar(), 1e-16);
}

}  // namespace
}  // namespace keyblock::loading
