#include "simulation/base.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../scene.h"
#include "core/index.h"

namespace keyblock::simulation {
namespace {

using loading::TimeTable;

TEST(Base, MotionsAreAlikeAtAllTimes) {
  const TimeTable none, zero({{0.0, 0.0}, {1.0, 0.0}}), ramp({{0.0, 0.0}, {1.0, 0.3}}),
      finer({{0.0, 0.0}, {0.5, 0.15}, {1.0, 0.3}}), jump({{0.0, 0.0}, {0.5, 0.3}, {1.0, 0.3}});
  const auto alike = [](const TimeTable& a, const TimeTable& b, bool as_y = false) {
    const TimeTable still;
    const FixedMotion motions[] = {{as_y ? still : a, as_y ? a : still},
                                   {as_y ? still : b, as_y ? b : still}};
    return move_alike(motions);
  };
  EXPECT_TRUE(move_alike({}));
  EXPECT_TRUE(alike(none, zero));
  EXPECT_TRUE(alike(ramp, finer));
  EXPECT_TRUE(alike(finer, ramp, true));
  EXPECT_FALSE(alike(ramp, none));
  EXPECT_FALSE(alike(none, ramp, true));
  EXPECT_FALSE(alike(ramp, jump));
  EXPECT_FALSE(alike(jump, ramp));
}

/// A way of `length` to the right within two seconds, smooth at both ends.
constexpr double way_time = 2.0;
double way(double t) {
  return t / way_time - std::sin(2.0 * std::numbers::pi * t / way_time) / (2.0 * std::numbers::pi);
}
double way_acceleration(double t) {
  return 2.0 * std::numbers::pi / (way_time * way_time) * std::sin(2.0 * std::numbers::pi * t / way_time);
}

/// A box of four fixed blocks with an opening in the rock that fills it: a block on a shelf that the motion lets fall,
/// one below it, and a third in the corner.
class ShakenBox {
 public:
  enum class By { fixed_blocks, ground };
  ShakenBox(By by, double length) : scene_(2e9, 12.0) {
    scene_.rectangle({-1.0, -1.0}, 6.0, 1.0, 0.0, true);
    scene_.rectangle({-1.0, 4.0}, 6.0, 1.0, 0.0, true);
    scene_.rectangle({-1.0, 0.0}, 1.0, 4.0, 0.0, true);
    scene_.rectangle({4.0, 0.0}, 1.0, 4.0, 0.0, true);
    scene_.rectangle({0.0, 0.0}, 2.0, 2.0);   // the shelf
    scene_.rectangle({1.58, 2.0}, 0.8, 0.5);  // on it, over its edge
    scene_.rectangle({0.0, 2.0}, 0.5, 0.5);
    RunSetup& setup = scene_.setup;
    setup.excavations = {{"niche", {{2.0, 0.0}, {4.0, 0.0}, {4.0, 2.0}, {2.0, 2.0}}}};
    setup.time_step = 0.002;
    setup.stages = {stage("settle", record::StageKind::settle), stage("move", record::StageKind::rest, 2.5)};
    setup.stages[0].excavate = {0};
    if (by == By::fixed_blocks) {
      std::vector<std::pair<double, double>> rows;
      for (int k = 0; k <= 1000; ++k) rows.emplace_back(0.002 * k, length * way(0.002 * k));
      for (std::size_t b = 0; b < 4; ++b) setup.properties[b].motion_x = TimeTable(rows);
    } else {
      std::vector<double> time;
      std::vector<Vec2> acceleration;
      for (int k = 0; k <= 1000; ++k) {
        time.push_back(0.002 * k);
        acceleration.push_back({length * way_acceleration(time.back()), 0.0});
      }
      setup.motions.push_back({"way", time, acceleration});
      setup.stages[1].kind = record::StageKind::shake;
      setup.stages[1].motion = 0;
    }
  }
  record::Damage damage() {
    record::RunObserver nobody;
    return run(scene_.setup, {}, nobody).stages.back().damage;
  }
  RunSetup& setup() { return scene_.setup; }

 private:
  Scene scene_;
};

TEST(Base, FixedBlocksThatMoveAndGroundThatDoesGiveTheSameDamage) {
  for (const double length : {0.5, -3.0}) {
    const record::Damage moved = ShakenBox(ShakenBox::By::fixed_blocks, length).damage(),
                         shaken = ShakenBox(ShakenBox::By::ground, length).damage();
    EXPECT_EQ(moved.fallen_blocks, length < 0.0 ? 1 : 0) << length;
    EXPECT_EQ(moved.fallen_area, shaken.fallen_area) << length;
    EXPECT_EQ(moved.loosened_area, shaken.loosened_area) << length;
    EXPECT_NEAR(moved.opening_filled_ratio, shaken.opening_filled_ratio, 1e-3) << length;
  }
}

// One of the fixed blocks stays: there is no common base, and the ways in space count.
TEST(Base, FixedBlocksThatMoveDifferentlyAreNone) {
  ShakenBox box(ShakenBox::By::fixed_blocks, 0.02);
  EXPECT_EQ(box.damage().loosened_area, 0.0);
  box.setup().properties[1].motion_x = {};
  EXPECT_GT(box.damage().loosened_area, 4.0);
}

// Openings go with the base, and what lies in them then counts.
TEST(Base, OpeningsMoveWithIt) {
  Scene scene(1e9, 30.0);
  scene.rectangle({0.0, 0.0}, 6.0, 1.0, 0.0, true);
  scene.rectangle({1.0, 3.0}, 1.0, 1.0);
  scene.setup.properties[0].motion_x = TimeTable({{0.0, 0.0}, {1.0, 10.0}});
  scene.setup.excavations = {{"opening", {{2.0, 1.0}, {5.0, 1.0}, {5.0, 4.0}, {2.0, 4.0}}}};
  Simulator simulator(scene);
  DamageGauge gauge(scene.setup, simulator.model);
  const auto move = [&](std::size_t b, Vec2 by) {
    const dynamics::Block& block = simulator.model.blocks[b];
    simulator.state.position[block.first] += by.x * std::sqrt(block.area);
    simulator.state.position[block.first + 1] += by.y * std::sqrt(block.area);
    contact::Surface& surface = simulator.model.surface;
    for (int v = surface.block_begin[b]; v < surface.block_begin[b + 1]; ++v) surface.position[at(v)] += by;
  };
  const std::vector<int> opening{0};
  move(0, {1.0, 0.0});  // before the reference, with the opening
  move(1, {1.0, 0.0});
  gauge.open(opening, simulator.state);
  gauge.start(simulator.state, {});
  move(0, {9.0, 0.0});
  move(1, {9.0, 0.0});
  EXPECT_EQ(gauge.measure(simulator.state).loosened_area, 0.0);
  move(1, {0.4, 0.0});
  EXPECT_EQ(gauge.status(simulator.state)[1], record::BlockStatus::loosened);
  EXPECT_NEAR(gauge.measure(simulator.state).opening_filled_ratio, 0.4 / 9.0, 1e-9);
  move(1, {0.2, 0.0});
  EXPECT_EQ(gauge.status(simulator.state)[1], record::BlockStatus::fallen);
}

}  // namespace
}  // namespace keyblock::simulation
