#include "record/verdict.h"

#include <gtest/gtest.h>

namespace keyblock::record {
namespace {

StageRecord settled() {
  StageRecord stage;
  stage.equilibrium_reached = true;
  return stage;
}

TEST(Verdict, TellsEquilibriumFromAWayToIt) {
  StageRecord stage = settled();
  stage.way = 0.0314159;
  stage.way_share = 0.0199;
  EXPECT_EQ(verdict_of(stage), Verdict::equilibrium);
  EXPECT_EQ(verdict_text(stage), "in equilibrium");
  stage.way_share = 0.0201;
  EXPECT_EQ(verdict_of(stage), Verdict::equilibrium_after_moving);
  EXPECT_EQ(verdict_text(stage), "in equilibrium after moving 0.031 m");
  stage.equilibrium_reached = false;
  EXPECT_EQ(verdict_of(stage), Verdict::not_reached);
  EXPECT_EQ(verdict_text(stage), "not reached");
}

// Blocks that press on each other are one mechanism only if each of them carries its weight.
TEST(Verdict, CallsMechanismsByTheirName) {
  StageRecord stage = settled();
  stage.moving = {{3, 1.0, 3}, {4, 0.95, 3}, {5, 0.9, 3}};
  EXPECT_EQ(verdict_of(stage), Verdict::moving);
  EXPECT_EQ(verdict_text(stage), "mechanism of 3 blocks");
  stage.moving[1].carried = 0.89;
  EXPECT_EQ(movement_of(stage, 0), Movement::partly_held);
  EXPECT_EQ(verdict_text(stage), "3 blocks moving");
  stage.moving[1] = {4, 0.05, 4};
  EXPECT_EQ(verdict_text(stage), "mechanism of 2 blocks, 1 block falling");
  stage.moving.push_back({9, 1.0, 9});
  EXPECT_EQ(verdict_text(stage), "mechanism of 2 blocks, mechanism of 1 block, 1 block falling");
  stage.moving.push_back({11, 1.0, 11});
  EXPECT_EQ(verdict_text(stage), "3 mechanisms of 4 blocks, 1 block falling");
}

TEST(Verdict, SaysWhenTheOthersAreNotInEquilibrium) {
  StageRecord stage;
  stage.moving = {{3, 0.0, 3}};
  EXPECT_EQ(verdict_text(stage), "1 block falling, equilibrium of the others not reached");
}

}  // namespace
}  // namespace keyblock::record
