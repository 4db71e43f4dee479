#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../scene.h"
#include "simulation/settle.h"

namespace keyblock::simulation {
namespace {

constexpr double asked_tolerance = 1e-4, block_weight = 2600.0 * g;

/// A floor, with blocks on it that the test names.
struct Settled : Simulator {
  explicit Settled(const Scene& scene) : Simulator(scene), settler(model, 0.002, asked_tolerance) {}

  /// Steps until the end, or so many. Whether the end was reached.
  bool settle(int most) {
    for (int k = 0; k < most; ++k) {
      if (settler.step(stepper, state, report)) return true;
    }
    return false;
  }

  Settler settler;
  dynamics::StepReport report;
};

Scene one_block(double above = 0.0) {
  Scene scene(1e9, 30.0);
  scene.rectangle({-1.0, -1.0}, 3.0, 1.0, 0.0, true);
  scene.rectangle({0.0, above}, 1.0, 1.0);
  return scene;
}

// The joint closes by W/(k L). It takes some steps to close by it, and one more to show that nothing goes on.
TEST(Settler, EndsAfterTwoStepsInBalance) {
  Scene scene = one_block();
  scene.setup.joints.standard.normal_stiffness = 1e8;
  Settled s(scene);
  ASSERT_TRUE(s.settle(200));
  EXPECT_EQ(s.settler.memory().quiet_steps, 2);
  EXPECT_LE(s.settler.worst_ratio(), asked_tolerance);
  EXPECT_EQ(s.settler.progress(), 1.0);
  const double closure = block_weight / 1e8,
               shortening = block_weight / (4.0 * 1e9);  // of the lower half under the mean stress
  EXPECT_NEAR(0.5 - s.centroid(1).y, closure + shortening, 1e-4 * closure);
}

TEST(Settler, ProgressBeginsAtNothingAndEndsWithAll) {
  Scene scene = one_block();
  scene.setup.joints.standard.normal_stiffness = 1e7;
  Settled s(scene);
  EXPECT_FALSE(s.settle(1));
  EXPECT_EQ(s.settler.progress(), 0.0);
  EXPECT_FALSE(s.settle(3));
  EXPECT_GT(s.settler.progress(), 0.0);
  ASSERT_TRUE(s.settle(200));
  EXPECT_EQ(s.settler.progress(), 1.0);
}

// In free air: nothing holds it, so it is named, held where it was named, and the rest is in equilibrium.
TEST(Settler, NamesWhatNothingHoldsAndHoldsItThere) {
  Settled s(one_block(0.5));
  ASSERT_TRUE(s.settle(200));
  const std::vector<bool> moves = s.settler.which_move();
  EXPECT_EQ(moves, (std::vector{false, true}));
  const std::vector<record::MovingBlock> moving = s.settler.moving(s.stepper);
  ASSERT_EQ(moving.size(), 1u);
  EXPECT_EQ(moving[0].block, 1);
  EXPECT_LT(moving[0].carried, 0.01);
  const double y = s.centroid(1).y;
  s.settler.step(s.stepper, s.state, s.report);
  EXPECT_NEAR(s.centroid(1).y, y, 1e-9);
}

TEST(Settler, BeginsAgainWhereTheSystemChanges) {
  Settled s(one_block());
  ASSERT_TRUE(s.settle(200));
  s.settler.begin_again();
  EXPECT_EQ(s.settler.memory().quiet_steps, 0);
  EXPECT_EQ(s.settler.memory().best_predicted, HUGE_VAL);
  EXPECT_FALSE(s.settle(1));
  EXPECT_TRUE(s.settle(1));
}

// Another settler that is given the memory goes on as the first would have.
TEST(Settler, GoesOnFromItsMemory) {
  Scene scene = one_block();
  scene.setup.joints.standard.normal_stiffness = 1e7;
  Settled one(scene), other(scene);
  for (int k = 0; k < 3; ++k) {
    one.settler.step(one.stepper, one.state, one.report);
    other.settler.step(other.stepper, other.state, other.report);
  }
  Settler restored(other.model, 0.002, asked_tolerance);
  restored.restore(other.settler.memory());
  for (int k = 0; k < 5; ++k) {
    one.settler.step(one.stepper, one.state, one.report);
    restored.step(other.stepper, other.state, other.report);
    EXPECT_EQ(one.settler.worst_ratio(), restored.worst_ratio()) << k;
    EXPECT_EQ(one.settler.memory().time_step, restored.memory().time_step) << k;
    EXPECT_EQ(one.settler.memory().inertia_scale, restored.memory().inertia_scale) << k;
  }
  EXPECT_EQ(one.state.position, other.state.position);
}

// What goes too far in a step has more inertia in the next: a soft joint closes in many steps, not in one that may jump over contacts.
TEST(Settler, GoesALongWayInManySteps) {
  Scene scene = one_block();
  scene.setup.joints.standard.normal_stiffness = 1e6;  // closes by 25 mm
  Settled s(scene);
  double farthest = 0.0;
  for (int k = 0; k < 200 && !s.settler.step(s.stepper, s.state, s.report); ++k)
    farthest = std::max(farthest, s.stepper.travel()[1]);
  EXPECT_NEAR(0.5 - s.centroid(1).y, block_weight / 1e6, 1e-3 * block_weight / 1e6);
  EXPECT_LT(farthest, 0.2 * block_weight / 1e6);
}

}  // namespace
}  // namespace keyblock::simulation
