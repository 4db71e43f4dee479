#include "simulation/joint_gauge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "../fresh_folder.h"
#include "../scene.h"
#include "core/index.h"
#include "record/damage_fields.h"

namespace keyblock::simulation {
namespace {

/// A block hangs at the right of a fixed one, along a joint of 1 m, in two pieces.
class HangingBlock : public ::testing::Test {
 protected:
  HangingBlock() : scene_(made()), simulator_(scene_), gauge_(scene_.setup, simulator_.model) {
    gauge_.start(simulator_.state, simulator_.stepper.find_contacts(simulator_.state));
  }

  void move(Vec2 by) {
    const dynamics::Block& block = simulator_.model.blocks[1];
    simulator_.state.position[block.first] += by.x * std::sqrt(block.area);
    simulator_.state.position[block.first + 1] += by.y * std::sqrt(block.area);
    contact::Surface& surface = simulator_.model.surface;
    for (int v = surface.block_begin[1]; v < surface.block_begin[2]; ++v) surface.position[at(v)] += by;
  }
  record::Damage measure() { return gauge_.measure(simulator_.state); }

  Scene scene_;
  Simulator simulator_;
  DamageGauge gauge_;

 private:
  static Scene made() {
    Scene scene(1e9, 30.0);
    scene.rectangle({0.0, 0.0}, 1.0, 1.0, 0.0, true);
    scene.rectangle({1.0, 0.0}, 1.0, 1.0);
    scene.setup.damage.fall_distance = 0.1;
    return scene;
  }
};

TEST_F(HangingBlock, ABlockThatFallsTakesNothingAway) {
  move({0.004, -0.03});
  record::Damage damage = measure();
  EXPECT_NEAR(damage.slip_max, 0.03, 1e-12);
  EXPECT_NEAR(damage.opening_max, 0.004, 1e-12);
  EXPECT_NEAR(damage.slipped_length, 1.0, 1e-12);
  EXPECT_EQ(damage.slip_max_ever, damage.slip_max);
  EXPECT_EQ(damage.opening_max_ever, damage.opening_max);
  EXPECT_EQ(damage.slipped_length_ever, damage.slipped_length);
  EXPECT_EQ(damage.opened_length_ever, damage.opened_length);

  move({0.0, -1.0});
  damage = measure();
  ASSERT_EQ(damage.fallen_blocks, 1);
  EXPECT_EQ(damage.slip_max, 0.0);
  EXPECT_EQ(damage.slipped_length, 0.0);
  EXPECT_EQ(damage.opening_max, 0.0);
  EXPECT_NEAR(damage.slip_max_ever, 0.03, 1e-12);
  EXPECT_NEAR(damage.opening_max_ever, 0.004, 1e-12);
  EXPECT_NEAR(damage.slipped_length_ever, 1.0, 1e-12);
  EXPECT_NEAR(damage.opened_length_ever, 1.0, 1e-12);
}

// A joint that slides to and fro has no slip in the end. What a look between saw is remembered.
TEST_F(HangingBlock, LooksBetweenMeasurementsCount) {
  move({0.0, -0.02});
  gauge_.watch(simulator_.state);
  move({0.0, 0.02});
  const record::Damage damage = measure();
  EXPECT_NEAR(damage.slip_max, 0.0, 1e-12);
  EXPECT_NEAR(damage.slip_max_ever, 0.02, 1e-12);
}

// A block slides down a face, held back by friction.
RunSetup dropping_block() {
  Scene scene(1e9, 20.0);
  scene.rectangle({0.0, 0.0}, 2.0, 1.0, 45.0, true);
  scene.rectangle(std::sqrt(0.5) * Vec2{-0.7, 1.3}, 0.5, 0.5, 45.0);
  scene.setup.time_step = 0.002;
  scene.setup.damage.fall_distance = 0.2;
  scene.setup.stages = {stage("start", record::StageKind::rest, 0.2),
                        stage("slide", record::StageKind::rest, 0.5),
                        stage("lie", record::StageKind::rest, 0.2)};
  return scene.setup;
}

TEST(JointGauge, AResumedRunRemembersTheSame) {
  const FreshFolder folder;
  record::RunObserver nobody;
  const record::RunRecord whole = run(dropping_block(), {}, nobody);
  ASSERT_EQ(whole.stages[0].damage.fallen_blocks, 0);
  ASSERT_EQ(whole.stages[1].damage.fallen_blocks, 1);
  EXPECT_GT(whole.stages[0].damage.slip_max, 0.01);
  EXPECT_EQ(whole.stages[1].damage.slip_max, 0.0);
  EXPECT_GT(whole.stages[1].damage.slip_max_ever, whole.stages[0].damage.slip_max_ever);

  Stopper stopper(400);  // in the last stage, when the block has fallen
  RunOptions options;
  options.directory = folder;
  options.stop = &stopper.stop;
  ASSERT_TRUE(run(dropping_block(), options, stopper).interrupted);
  options.stop = nullptr;
  options.resume = true;
  const record::RunRecord resumed = run(dropping_block(), options, nobody);
  ASSERT_EQ(resumed.state_hash, whole.state_hash);
  for (std::size_t k = 0; k < 3; ++k) {
    for (const auto& field : record::damage_fields) {
      const double one = resumed.stages[k].damage.*field.number, other = whole.stages[k].damage.*field.number;
      EXPECT_TRUE(one == other || (std::isnan(one) && std::isnan(other))) << field.name;
    }
  }
}

}  // namespace
}  // namespace keyblock::simulation
