#include "record/standing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../scene.h"
#include "core/index.h"

namespace keyblock::simulation {
namespace {

/// m.
constexpr double loosened = 0.01;

record::StageRecord record_of(record::StageKind kind) {
  record::StageRecord record;
  record.stage.kind = kind;
  record.equilibrium_reached = kind == record::StageKind::settle;
  return record;
}

TEST(Standing, OfStaticStages) {
  record::StageRecord record = record_of(record::StageKind::settle);
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::stands);
  record.moving = {{3, 1.0}};
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::moves);
  record.damage.fallen_blocks = 1;
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::collapsed);
  record = record_of(record::StageKind::settle);
  record.equilibrium_reached = false;
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::unsettled);
}

TEST(Standing, WhatBalancesAndIsNotStableDoesNotStand) {
  record::StageRecord record = record_of(record::StageKind::settle);
  record.unstable_block = 3;
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::unstable);
}

TEST(Standing, OfDynamicStages) {
  record::StageRecord record = record_of(record::StageKind::rest);
  record.largest_speed = 0.009;
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::stands);
  record.largest_speed = 0.011;
  record.movers = {1, 0, 1e4, 1e4, 0.005};
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::rocks);
  record.movers.way = 0.02;
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::moves);
  record.damage.fallen_blocks = 1;
  record.largest_speed = 0.0;  // lies still after the fall
  EXPECT_EQ(record::standing_of(record, loosened, false), record::Standing::collapsed);
  EXPECT_EQ(record::standing_of(record, loosened, true), record::Standing::fallen);
}

/// A column of three drums, 0.8 m wide and 3 m high, under gravity that leans by so much of itself: 0.267 topples it.
record::StageRecord leaning_column(double lean, double duration) {
  Scene scene(5e9, 40.0);
  scene.rectangle({-4.0, -1.0}, 8.0, 1.0, 0.0, true);
  for (const double bottom : {0.0, 1.0, 2.0}) scene.rectangle({0.0, bottom}, 0.8, 1.0);
  scene.setup.gravity = {lean * g, -g};
  scene.setup.time_step = 0.005;
  scene.setup.stages = {stage("rest", record::StageKind::rest, duration)};
  record::RunObserver nobody;
  return run(scene.setup, {}, nobody).stages.back();
}

TEST(Standing, AColumnStandsMovesOrHasCollapsed) {
  const record::StageRecord stands = leaning_column(0.2, 2.0);
  EXPECT_EQ(stands.standing, record::Standing::stands);
  EXPECT_LT(stands.damage.rotation_max, 0.2);
  EXPECT_LT(stands.damage.displacement_max, 0.01);
  EXPECT_EQ(stands.damage.fallen_blocks, 0);
  EXPECT_EQ(stands.damage.hinges, 0);

  const record::StageRecord moves = leaning_column(0.32, 0.8);
  EXPECT_EQ(moves.standing, record::Standing::moves);
  EXPECT_EQ(moves.damage.fallen_blocks, 0);
  EXPECT_GT(moves.damage.rotation_max, 1.0);
  EXPECT_GE(moves.damage.hinges, 1);
  EXPECT_GT(moves.largest_speed, 0.05);

  const record::StageRecord collapsed = leaning_column(0.32, 3.0);
  EXPECT_EQ(collapsed.standing, record::Standing::collapsed);
  EXPECT_GE(collapsed.damage.fallen_blocks, 1);
  EXPECT_GT(collapsed.damage.rotation_max, 45.0);
  EXPECT_GT(collapsed.damage.displacement_max, 1.0);
}

// Half of √(area), down: for 1 m² 0.5 m, for 0.01 m² 5 cm. Nothing falls where nothing weighs, and in a tunnel the opening counts.
TEST(Standing, WhatFallsWithoutAnOpening) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 1.0, 1.0);
  scene.rectangle({2.0, 0.0}, 0.1, 0.1);
  const auto statuses = [&](const RunSetup& setup, Vec2 large, Vec2 small) {
    Simulator simulator(scene);
    simulator.model.gravity = setup.gravity;
    DamageGauge gauge(setup, simulator.model);
    gauge.start(simulator.state, {});
    for (std::size_t b = 0; b < 2; ++b) {
      const dynamics::Block& block = simulator.model.blocks[b];
      const Vec2 by = std::sqrt(block.area) * (b == 0 ? large : small);
      simulator.state.position[block.first] += by.x;
      simulator.state.position[block.first + 1] += by.y;
    }
    return gauge.status(simulator.state);
  };
  using S = std::vector<record::BlockStatus>;
  const record::BlockStatus loose = record::BlockStatus::loosened, fallen = record::BlockStatus::fallen;
  EXPECT_EQ(statuses(scene.setup, {0.0, -0.49}, {0.0, -0.049}), (S{loose, loose}));
  EXPECT_EQ(statuses(scene.setup, {0.0, -0.51}, {0.0, -0.051}), (S{fallen, fallen}));
  EXPECT_EQ(statuses(scene.setup, {3.0, -0.4}, {3.0, 0.0}), (S{loose, loose}));  // aside
  RunSetup weightless = scene.setup;
  weightless.gravity = {};
  EXPECT_EQ(statuses(weightless, {0.0, -5.0}, {0.0, -5.0}), (S{loose, loose}));
  RunSetup given = scene.setup;
  given.damage.fall_distance = 0.2;
  EXPECT_EQ(statuses(given, {0.0, -0.3}, {0.0, -0.1}), (S{fallen, loose}));
}

}  // namespace
}  // namespace keyblock::simulation
