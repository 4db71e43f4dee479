#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>

#include "../resumed_run.h"
#include "../scene.h"
#include "simulation/run.h"

namespace keyblock::simulation {
namespace {

constexpr double time_step = 0.001;

loading::TimeTable table(double duration, const auto& displacement) {
  std::vector<std::pair<double, double>> rows;
  for (long k = 0; k <= std::lround(duration / time_step); ++k) {
    const double t = static_cast<double>(k) * time_step;
    rows.emplace_back(t, displacement(t));
  }
  return loading::TimeTable(std::move(rows));
}

/// A block at rest on a fixed base, block 1 on block 0.
Scene on_base(double friction) {
  Scene scene(5e10, friction);
  scene.rectangle({-5.0, -1.0}, 10.0, 1.0, 0.0, true);
  scene.rectangle({0.0, 0.0}, 1.0, 0.5);
  return scene;
}

// Block on an oscillating base, u = D (1 − cos ωt), μ = 0.3 (MacLaughlin & Doolin 2006): absolute displacements from the
// integral of the Coulomb slider.
TEST(PrescribedMotion, DragsABlockByFriction) {
  Scene scene = on_base(std::atan(0.3) * 180.0 / std::numbers::pi);
  scene.setup.properties[0].motion_x =
      table(5.0, [](double t) { return 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t)); });
  Simulator s(scene);
  const double start = s.centroid(1).x;
  double before = 0.0;
  for (const auto& [time, expected] : {std::pair{1.0, 0.52769}, {2.0, 0.81151}, {5.0, 1.09120}}) {
    s.run(time - before, time_step);
    before = time;
    EXPECT_NEAR(s.centroid(1).x - start, expected, 0.005 * expected) << time;
  }
  EXPECT_NEAR(s.centroid(0).x, scene.setup.properties[0].motion_x(5.0), 1e-12);
  EXPECT_LT(std::abs(s.residual()), 1e-3 * std::max(s.state.ledger.friction, s.state.ledger.input));
  EXPECT_EQ(s.unconverged, 0);
}

// A base that lifts a block does work on it.
TEST(PrescribedMotion, WorkIsInput) {
  Scene scene = on_base(30.0);
  scene.setup.properties[0].motion_y = table(
      2.0, [](double t) { return 0.1 * (t < 1.0 ? 0.5 * (1.0 - std::cos(std::numbers::pi * t)) : 1.0); });
  Simulator s(scene);
  const double start = s.centroid(1).y;
  s.run(2.0, time_step);
  const double weight = 2600.0 * 0.5 * 9.81;
  EXPECT_NEAR(s.centroid(1).y - start, 0.1, 1e-4);
  EXPECT_NEAR(s.state.ledger.input, 0.1 * weight, 1e-2 * 0.1 * weight);
  EXPECT_LT(std::abs(s.residual()), 1e-3 * s.state.ledger.input);
}

// A wall that comes from afar finds the block within the steps in which it meets it.
TEST(PrescribedMotion, AWallPushesABlock) {
  Scene scene(5e10, 0.0);
  scene.setup.gravity = {0.0, 0.0};
  scene.rectangle({-3.0, -1.0}, 1.0, 2.0, 0.0, true);
  scene.rectangle({0.0, -0.5}, 1.0, 1.0);
  scene.setup.properties[0].motion_x = loading::TimeTable({{0.0, 0.0}, {1.0, 4.0}});
  scene.setup.solver.restitution = 0.0;
  Simulator s(scene);
  const double start = s.centroid(1).x;
  s.run(1.0, time_step);
  EXPECT_GE(s.centroid(1).x - start, 2.0 - 1e-3);
  EXPECT_GE(s.velocity(1).x, 4.0 - 0.05);
  s.run(0.5, time_step);
  EXPECT_NEAR(s.centroid(0).x, 1.5, 1e-12);
  EXPECT_EQ(s.velocity(0).x, 0.0);
}

TEST(PrescribedMotion, ResumedRunsEndInTheSameBits) {
  Scene scene = on_base(30.0);
  RunSetup setup = scene.setup;
  setup.properties[0].motion_x =
      table(3.0, [](double t) { return 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * t)); });
  setup.time_step = time_step;
  record::Stage stage;
  stage.name = "moved";
  stage.kind = record::StageKind::rest;
  stage.duration = 3.0;
  setup.stages.push_back(stage);
  record::RunObserver nobody;
  const record::RunRecord whole = run(setup, {}, nobody);

  Stopper stopper(2500);
  EXPECT_EQ(resumed_run(setup, stopper).state_hash, whole.state_hash);
}

}  // namespace
}  // namespace keyblock::simulation
