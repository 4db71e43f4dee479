#include "simulation/energy_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../scene.h"
#include "core/error.h"
#include "simulation/computation_errors.h"
#include "simulation/energy_audit.h"

namespace keyblock::simulation {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

RunRecord missing(double ratio) {
  RunRecord run;
  run.energy.residual_ratio = ratio;
  return run;
}

std::string balance_failure_of(double ratio, bool interrupted = false) {
  RunRecord run = missing(ratio);
  run.interrupted = interrupted;
  try {
    check_computation(run);
  } catch (const RunError& error) {
    return error.what();
  }
  return {};
}

TEST(EnergyWarnings, SayWhatTheBalanceMisses) {
  EXPECT_THAT(energy_warnings(missing(0.0)), IsEmpty());
  EXPECT_THAT(energy_warnings(missing(0.01)), IsEmpty());
  EXPECT_THAT(energy_warnings(missing(0.0123)),
              ElementsAre(AllOf(HasSubstr("misses 1.23 % of its largest term, more than 1 %"),
                                HasSubstr("compare with a run with a smaller time.step"))));
  EXPECT_THAT(energy_warnings(missing(0.05)), ElementsAre(HasSubstr("more than 1 %")));
  EXPECT_THAT(energy_warnings(missing(2.22)),
              ElementsAre(AllOf(HasSubstr("misses 222 % of its largest term, more than 5 %"),
                                HasSubstr("the results are not to be used"))));
}

TEST(EnergyWarnings, SayWhatTheTimeIntegrationHasMade) {
  RunRecord run = missing(1e-6);
  run.made_ratio = 0.1;
  EXPECT_THAT(energy_warnings(run), IsEmpty());
  run.made_ratio = 1.37;
  EXPECT_THAT(energy_warnings(run), ElementsAre(HasSubstr("has made energy, 137 % of the largest term")));
  run.energy.residual_ratio = 0.5;
  EXPECT_EQ(energy_warnings(run).size(), 2U);
}

TEST(EnergyWarnings, ARunThatMissesTooMuchHasFailed) {
  EXPECT_EQ(balance_failure_of(0.05), "");
  EXPECT_THAT(balance_failure_of(0.0501),
              AllOf(HasSubstr("misses 5.01 %"), HasSubstr("the results are kept")));
  EXPECT_THAT(balance_failure_of(std::numeric_limits<double>::quiet_NaN()), HasSubstr("more than 5 %"));
  EXPECT_EQ(balance_failure_of(2.22, true), "");
}

/// A block of 1 m² and 2,600 kg, 1 GPa.
Simulator one_block(Vec2 gravity) {
  Scene scene(1e9, 30.0);
  scene.setup.gravity = gravity;
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  return Simulator(scene);
}

double ratio_of(Simulator& s, double missed) {
  s.state.ledger.friction = missed;
  return energy_audit(s.model, s.state, s.initial_energy).residual_ratio;
}

// What lifts the block by a nanometre, or strains it by 10⁻⁹.
TEST(EnergyAudit, WhatNobodySeesIsNoResidual) {
  Simulator heavy = one_block({0.0, -g}), weightless = one_block({});
  EXPECT_LT(ratio_of(heavy, 0.0), 1e-9);
  EXPECT_NEAR(ratio_of(heavy, 1e-8), 1e-8 / (2600.0 * g * 1e-9), 1e-6);
  EXPECT_NEAR(ratio_of(heavy, 1.0), 1.0, 1e-12);
  EXPECT_LT(ratio_of(weightless, 0.0), 1e-9);
  EXPECT_NEAR(ratio_of(weightless, 1e-12), 1e-12 / (0.5 * 1e9 * 1e-18), 1e-9);
  EXPECT_NEAR(ratio_of(weightless, 1e-6), 1.0, 1e-12);
  EXPECT_FALSE(std::isfinite(ratio_of(heavy, std::numeric_limits<double>::infinity())));
  EXPECT_FALSE(std::isfinite(ratio_of(heavy, std::numeric_limits<double>::quiet_NaN())));
}

TEST(EnergyAudit, EnergyThatIsMadeIsMeasuredByAllOtherTerms) {
  Simulator s = one_block({0.0, -g});
  Energy energy;
  energy.numerical = -30.0;
  energy.friction = 20.0;
  energy.kinetic = 10.0;
  EXPECT_EQ(made_ratio(s.model, energy), 1.5);
  energy.numerical = 30.0;
  EXPECT_EQ(made_ratio(s.model, energy), 0.0);
  energy = {};
  energy.numerical = -1e-15;  // rounding
  EXPECT_LT(made_ratio(s.model, energy), 1e-9);
}

}  // namespace
}  // namespace keyblock::simulation
