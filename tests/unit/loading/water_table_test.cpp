#include "loading/water_table.h"

#include <gtest/gtest.h>

namespace keyblock::loading {
namespace {

TEST(WaterTable, IsLevelBeyondItsEnds) {
  const WaterTable table({{0.0, 10.0}, {10.0, 4.0}});
  EXPECT_EQ(table.height(-5.0), 10.0);
  EXPECT_EQ(table.height(5.0), 7.0);
  EXPECT_EQ(table.height(50.0), 4.0);
  EXPECT_EQ(table.head({5.0, 6.0}), 1.0);
  EXPECT_EQ(table.head({5.0, 8.0}), 0.0);
}

TEST(WaterTable, SharesOfAStraightHeadAreExact) {
  const WaterTable table({{0.0, 5.0}});
  const WaterTable::Shares level = table.shares({0.0, 2.0}, {4.0, 2.0}, 0.0, 1.0);
  EXPECT_DOUBLE_EQ(level.start, 1.5);
  EXPECT_DOUBLE_EQ(level.end, 1.5);
  EXPECT_TRUE(level.is_straight);
  const WaterTable::Shares upright = table.shares({0.0, 5.0}, {0.0, 2.0}, 0.0, 1.0);  // a triangle
  EXPECT_DOUBLE_EQ(upright.start, 0.5);
  EXPECT_DOUBLE_EQ(upright.end, 1.0);
}

// Of a wall that stands out of the water by half: the lower half has a triangle.
TEST(WaterTable, SharesEndAtTheTable) {
  const WaterTable table({{0.0, 5.0}});
  const WaterTable::Shares half = table.shares({0.0, 7.0}, {0.0, 3.0}, 0.0, 1.0);
  EXPECT_FALSE(half.is_straight);
  EXPECT_NEAR(half.start + half.end, 0.5, 1e-15);
  EXPECT_NEAR(half.end, 0.5 * 5.0 / 6.0, 1e-15);
  EXPECT_EQ(table.shares({0.0, 9.0}, {4.0, 6.0}, 0.0, 1.0).end, 0.0);
}

TEST(WaterTable, PartsSumToTheWhole) {
  const WaterTable table({{0.0, 5.0}, {1.0, 3.0}, {2.0, 6.0}});
  const Vec2 from{-1.0, 4.0}, to{3.0, 2.5};
  const WaterTable::Shares whole = table.shares(from, to, 0.0, 1.0),
                           first = table.shares(from, to, 0.0, 0.37),
                           second = table.shares(from, to, 0.37, 1.0);
  EXPECT_NEAR(first.start + second.start, whole.start, 1e-14);
  EXPECT_NEAR(first.end + second.end, whole.end, 1e-14);
  EXPECT_FALSE(whole.is_straight);
}

}  // namespace
}  // namespace keyblock::loading
