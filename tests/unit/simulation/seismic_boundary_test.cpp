#include "coupling/seismic_boundary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../resumed_run.h"
#include "../scene.h"
#include "simulation/base.h"
#include "simulation/build_boundary.h"
#include "simulation/runner.h"

namespace keyblock::simulation {
namespace {

constexpr double rock_density = 2600.0, rock_young = 2e8;

loading::GroundMotion wavelet(Vec2 direction, double peak) {
  std::vector<double> times;
  std::vector<Vec2> accelerations;
  for (int k = 0; k <= 400; ++k) {
    const double t = 0.0025 * k, squared = std::pow(std::numbers::pi * 4.0 * (t - 0.4), 2);
    times.push_back(t);
    accelerations.push_back(peak * (1.0 - 2.0 * squared) * std::exp(-squared) * direction);
  }
  return {"wavelet", times, accelerations};
}

/// Four by five blocks of soft rock, glued together: 20 m wide and high, on a half-space.
RunSetup ground(record::Sides sides = record::Sides::free_field) {
  Scene scene(rock_young, 40.0, rock_density);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 4; ++column) scene.rectangle({5.0 * column, 4.0 * row}, 5.0, 4.0);
  }
  RunSetup setup = std::move(scene.setup);
  setup.joints.standard.cohesion = setup.joints.standard.tension = 1e9;
  setup.time_step = 0.0025;
  setup.solver.integrator = dynamics::TimeIntegration::generalized_alpha;
  Boundary boundary;
  boundary.sides = sides;
  dynamics::RockLayer rock{.density = rock_density};
  rock.shear = rock_young / 2.4;
  rock.upright = rock_young / (1.0 - 0.04);
  rock.sideways = 0.2 * rock.upright;
  boundary.layers = {rock};
  boundary.dashpots = rock.impedance();
  setup.boundary = boundary;
  setup.motions = {wavelet({0.8, 0.6}, 3.0)};
  setup.stages = {stage("settle", record::StageKind::settle), stage("shake", record::StageKind::shake),
                  stage("after", record::StageKind::rest, 0.1), stage("again", record::StageKind::settle)};
  return setup;
}

record::RunRecord ground_run(const RunSetup& setup, const RunOptions& options = {}) {
  record::RunObserver nobody;
  return run(setup, options, nobody);
}

/// The run, which has the same bits by two threads, and after an interruption within the shaking.
record::RunRecord run_with_the_same_bits(const RunSetup& setup) {
  record::RunRecord whole = ground_run(setup);
  RunOptions two;
  two.threads = 2;
  EXPECT_EQ(ground_run(setup, two).state_hash, whole.state_hash);
  Stopper stopper(whole.stages[0].steps + 250);
  const record::RunRecord resumed = resumed_run(setup, stopper);
  EXPECT_EQ(resumed.state_hash, whole.state_hash);
  EXPECT_EQ(resumed.energy.radiated, whole.energy.radiated);
  EXPECT_EQ(resumed.energy.damping, whole.energy.damping);
  return whole;
}

TEST(SeismicBoundary, HasTheSameBitsForAnyThreadsAndAfterAnInterruption) {
  run_with_the_same_bits(ground());
}

// At its height beside each side, where the ground is not equally high.
TEST(SeismicBoundary, HistoriesFollowTheRockOnEitherSide) {
  RunSetup setup = ground();
  setup.system.blocks.pop_back();  // the top one on the right
  setup.properties.pop_back();
  EXPECT_EQ(column_heights(setup, ColumnSide::left).ground, 20.0);
  EXPECT_EQ(column_heights(setup, ColumnSide::right).ground, 16.0);
  EXPECT_EQ(column_heights(setup, ColumnSide::right).base, 0.0);
  setup.stages = {stage("shake", record::StageKind::shake)};
  setup.histories = {{"left", "", {0.0, 15.0}, false, ColumnSide::left},
                     {"right", "", {0.0, 15.0}, false, ColumnSide::right}};
  LastHistory histories;
  double apart = 0.0;
  RunOptions options;
  options.after_step = [&](const Runner& runner, const dynamics::StepReport&) {
    ASSERT_EQ(histories.last.points.size(), 2u);
    const record::HistoryRow::Point &left = histories.last.points[0], &right = histories.last.points[1];
    const dynamics::GroundMove on_left = far_ground(runner.model(), runner.state(), {0.0, 15.0}),
                               on_right = far_ground(runner.model(), runner.state(), {20.0, 15.0});
    EXPECT_EQ(left.ux, on_left.displacement.x);
    EXPECT_EQ(left.vy, on_left.velocity.y);
    EXPECT_EQ(right.ux, on_right.displacement.x);
    EXPECT_EQ(right.vy, on_right.velocity.y);
    EXPECT_TRUE(std::isnan(left.sxx));
    apart = std::max(apart, std::abs(left.vx - right.vx));
  };
  run(setup, options, histories);
  EXPECT_GT(apart, 1e-3);
}

// The ground sways by a centimetre and more against the outcrop, and nothing has happened to it.
TEST(SeismicBoundary, CountsDamageAgainstTheGroundFarAway) {
  RunSetup setup = ground();
  setup.motions = {wavelet({1.0, 0.0}, 10.0)};
  setup.gravity = {};
  setup.stages = {stage("shake", record::StageKind::shake), stage("after", record::StageKind::rest, 1.0)};
  double sway = 0.0;
  RunOptions options;
  options.after_step = [&](const Runner& runner, const dynamics::StepReport&) {
    const dynamics::Block& top = runner.model().blocks.back();
    sway =
        std::max(sway, std::abs(runner.state().position[top.first] / std::sqrt(top.area) - top.centroid.x));
  };
  const record::RunRecord record = ground_run(setup, options);
  EXPECT_GT(sway, 0.013);
  for (const record::StageRecord& s : record.stages) {
    EXPECT_EQ(s.damage.loosened_area, 0.0) << s.stage.name;
    EXPECT_LT(s.damage.displacement_max, 1e-3) << s.stage.name;
  }
}

// Waves carry away what the shaking brings, and the books balance.
TEST(SeismicBoundary, AccountsForWhatItTakes) {
  for (const record::Sides sides :
       {record::Sides::free_field, record::Sides::viscous, record::Sides::roller}) {
    const record::RunRecord record = ground_run(ground(sides));
    EXPECT_LT(record.energy.residual_ratio, 1e-4);
    EXPECT_GT(record.energy.radiated, 0.0);
    EXPECT_FALSE(record.interrupted);
  }
}

// Long after the shaking all is where it was: on an elastic half-space nothing stays displaced.
TEST(SeismicBoundary, ComesBackToRest) {
  RunSetup setup = ground();
  setup.stages[2].duration = 2.0;
  RunOptions options;
  double fastest = 0.0;
  options.after_step = [&](const Runner& runner, const dynamics::StepReport&) {
    fastest = 0.0;
    for (const double v : runner.state().velocity) fastest = std::max(fastest, std::abs(v));
  };
  setup.stages.pop_back();
  ground_run(setup, options);
  EXPECT_LT(fastest, 1e-5);
}

// So they do with damping; runs have the same bits for any threads and after an interruption.
TEST(SeismicBoundary, TakesDampingAgainstTheGroundFarAway) {
  RunSetup setup = ground();
  setup.solver.rock_damping = setup.solver.contact_damping = 0.0;
  setup.solver.damping = {0.05, 3.0, dynamics::DampingKind::rayleigh};
  const record::RunRecord whole = run_with_the_same_bits(setup);
  EXPECT_LT(whole.energy.residual_ratio, 1e-4);
  EXPECT_GT(whole.energy.damping, 0.0);
}

// In ground that moves as one, damping in proportion to mass finds nothing to slow, however much there is.
TEST(SeismicBoundary, LeavesTheGroundItsMotion) {
  const auto largest_damping = [](const std::optional<dynamics::RayleighDamping>& damping) {
    RunSetup setup = ground();
    setup.motions = {wavelet({1.0, 0.0}, 3.0)};
    setup.gravity = {};
    setup.solver.rock_damping = setup.solver.contact_damping = 0.0;
    setup.solver.damping = damping;
    setup.stages = {stage("shake", record::StageKind::shake)};
    const record::RunRecord record = ground_run(setup);
    return record.energy.damping / record.energy.radiated;
  };
  EXPECT_LT(largest_damping(dynamics::RayleighDamping{0.5, 3.0, dynamics::DampingKind::mass}), 1e-4);
  EXPECT_GT(largest_damping(dynamics::RayleighDamping{0.05, 3.0, dynamics::DampingKind::stiffness}), 1e-2);
}

// Without a seismic boundary it is against the base: what falls comes to g/α.
TEST(SeismicBoundary, DampingAgainstTheBaseSlowsFalls) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0, 20.0);
  RunSetup setup = std::move(scene.setup);
  setup.time_step = 0.01;
  setup.solver.damping = {0.2, 3.0, dynamics::DampingKind::mass};
  setup.stages = {stage("fall", record::StageKind::rest, 3.0)};
  double speed = 0.0;
  RunOptions options;
  options.after_step = [&](const Runner& runner, const dynamics::StepReport&) {
    speed = -runner.state().velocity[1];
  };
  const record::RunRecord record = ground_run(setup, options);
  EXPECT_NEAR(speed, 9.81 / setup.solver.damping->mass_rate(), 1e-6);
  EXPECT_LT(record.energy.residual_ratio, 1e-9);
}

// Edges within the model are no boundary; a column of far rock reaches up to the ground of its side.
TEST(SeismicBoundary, StandsOnTheSidesOfTheModel) {
  RunSetup setup = ground();
  setup.system.blocks.erase(setup.system.blocks.begin() + 19);  // at the upper right
  setup.properties.erase(setup.properties.begin() + 19);
  dynamics::Model model = build_model(setup);
  const auto* boundary = dynamic_cast<const dynamics::SeismicBoundary*>(model.couplings.back().get());
  ASSERT_NE(boundary, nullptr);
  double base = 0.0, sides = 0.0;
  for (const dynamics::BoundaryPoint& p : boundary->boundary_points()) {
    (p.normal.y != 0.0 ? base : sides) += p.length;
    EXPECT_TRUE(p.absorbs);
    EXPECT_EQ(p.far, p.normal.x > 0.0 ? 1 : p.normal.x < 0.0 ? 0 : -1);
  }
  EXPECT_DOUBLE_EQ(base, 20.0);
  EXPECT_DOUBLE_EQ(sides, 20.0 + 16.0);
  ASSERT_EQ(boundary->far_rock().size(), 2u);
  EXPECT_EQ(boundary->far_rock()[0].column.heights().back(), 20.0);
  EXPECT_EQ(boundary->far_rock()[1].column.heights().back(), 16.0);
}

// The top of a deep model is under the weight above, which the stress of the rock holds: nothing moves.
TEST(SeismicBoundary, HoldsTheStressThatWasThere) {
  RunSetup setup = ground();
  block::InSituStress stress;
  stress.syy = -1e6;
  stress.sxx = -0.5e6;
  stress.sxy = 0.1e6;
  setup.gravity = {};
  setup.in_situ = stress;
  setup.boundary->overburden = true;
  setup.boundary->depth = 40.0;
  Scene scene(rock_young, 40.0, rock_density);
  scene.setup = setup;
  Simulator s(scene);
  s.run(0.5, setup.time_step);
  for (const double v : s.state.velocity) EXPECT_NEAR(v, 0.0, 1e-9);
}

}  // namespace
}  // namespace keyblock::simulation
