#include "record/energy_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../resumed_run.h"
#include "../scene.h"
#include "core/error.h"
#include "record/computation_errors.h"
#include "simulation/energy_audit.h"

namespace keyblock::simulation {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

record::RunRecord missing(double ratio) {
  record::RunRecord run;
  run.energy.residual_ratio = ratio;
  return run;
}

std::string balance_failure_of(double ratio, bool interrupted = false) {
  record::RunRecord run = missing(ratio);
  run.interrupted = interrupted;
  try {
    record::check_computation(run);
  } catch (const RunError& error) {
    return error.what();
  }
  return {};
}

TEST(EnergyWarnings, SayWhatTheBalanceMisses) {
  EXPECT_THAT(record::energy_warnings(missing(0.0)), IsEmpty());
  EXPECT_THAT(record::energy_warnings(missing(0.01)), IsEmpty());
  EXPECT_THAT(record::energy_warnings(missing(0.0123)),
              ElementsAre(AllOf(HasSubstr("misses 1.23 % of its largest term, more than 1 %"),
                                HasSubstr("compare with a run with a smaller time.step"))));
  EXPECT_THAT(record::energy_warnings(missing(0.05)), ElementsAre(HasSubstr("more than 1 %")));
  EXPECT_THAT(record::energy_warnings(missing(2.22)),
              ElementsAre(AllOf(HasSubstr("misses 222 % of its largest term, more than 5 %"),
                                HasSubstr("the results are not to be used"))));
}

TEST(EnergyWarnings, SayWhatTheTimeIntegrationHasMade) {
  record::RunRecord run = missing(1e-6);
  run.made.ratio = 0.1;
  EXPECT_THAT(record::energy_warnings(run), IsEmpty());
  run.made.ratio = 1.37;
  run.made.time = 2.5;
  EXPECT_THAT(record::energy_warnings(run),
              ElementsAre(HasSubstr(
                  "has made energy, 137 % of the largest term that is accounted for at 2.5 s: compare")));
  run.made.most = 0.6;
  run.made.largest = 1.0;
  EXPECT_THAT(record::energy_warnings(run), ElementsAre(HasSubstr("the results are not to be used")));
  run.energy.residual_ratio = 0.5;
  EXPECT_EQ(record::energy_warnings(run).size(), 2U);
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
  record::Energy energy;
  energy.friction = 20.0;
  energy.kinetic = 10.0;
  record::MadeEnergy made;
  energy.numerical = 30.0;
  watch_made(s.model, energy, 0.5, made);
  EXPECT_EQ(made.ratio, 0.0);
  energy.numerical = 0.0;
  watch_made(s.model, energy, 1.0, made);
  EXPECT_EQ(made.ratio, 1.5);
  EXPECT_EQ(made.time, 1.0);
  EXPECT_EQ(made.share(), 1.5);
  // What is lost later does not make it good; what moves later may be far more.
  energy.numerical = 20.0;
  energy.friction = 1e6;
  watch_made(s.model, energy, 2.0, made);
  energy.numerical = 1e9;
  watch_made(s.model, energy, 3.0, made);
  EXPECT_EQ(made.ratio, 1.5);
  EXPECT_EQ(made.time, 1.0);
  EXPECT_EQ(made.share(), 30.0 / 1e6);
}

/// A block of 1 m that falls by 3 mm, below the speed of an impact, and bounces.
RunSetup small_bounce(double radius) {
  Scene scene(1e10, 35.0);
  scene.rectangle({-5.0, -1.0}, 10.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.003}, 1.0, 1.0);
  scene.setup.time_step = 0.004;
  scene.setup.stages = {stage("falls", record::StageKind::rest, 2.0)};
  scene.setup.solver.integrator = dynamics::TimeIntegration::generalized_alpha;
  scene.setup.solver.spectral_radius = radius;
  return scene.setup;
}

// With a radius of 0.3 it comes to rest in the end: the sum of what was lost and made is a loss.
TEST(EnergyAudit, EnergyMadeInSmallBounces) {
  record::RunObserver nobody;
  const record::RunRecord low = run(small_bounce(0.0), {}, nobody), high = run(small_bounce(0.3), {}, nobody);
  EXPECT_LT(low.made.ratio, 1e-9);
  EXPECT_GT(high.energy.numerical, 0.0);
  EXPECT_GT(high.made.share(), record::failed_made);
  EXPECT_GT(high.made.time, 0.02);
  EXPECT_THAT(record::failed_balances(high), ElementsAre(HasSubstr("has made energy")));
}

// From the end of the first stage on, before its worst moment and after it.
TEST(EnergyAudit, AResumedRunHasTheSameWorstMoment) {
  for (const double first : {0.6, 1.4}) {
    RunSetup setup = small_bounce(0.3);
    setup.stages = {stage("falls", record::StageKind::rest, first),
                    stage("bounces", record::StageKind::rest, 2.0 - first)};
    record::RunObserver nobody;
    const record::RunRecord whole = run(setup, {}, nobody);
    EXPECT_EQ(whole.made.time > first, first < 1.0) << whole.made.time;
    Stopper stopper(std::lround(first / setup.time_step) + 10);
    const record::RunRecord resumed = resumed_run(setup, stopper);
    EXPECT_EQ(resumed.made.ratio, whole.made.ratio);
    EXPECT_EQ(resumed.made.time, whole.made.time);
    EXPECT_EQ(resumed.made.highest, whole.made.highest);
    EXPECT_EQ(resumed.made.share(), whole.made.share());
  }
}

TEST(EnergyAudit, RoundingMakesNoEnergy) {
  Simulator s = one_block({0.0, -g});
  record::Energy energy;
  energy.numerical = -1e-15;
  record::MadeEnergy made;
  watch_made(s.model, energy, 1.0, made);
  EXPECT_LT(made.ratio, 1e-9);
}

}  // namespace
}  // namespace keyblock::simulation
