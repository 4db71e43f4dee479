#include "rockmass/intensity.h"

#include <gtest/gtest.h>

namespace keyblock::rockmass {
namespace {

const Box rectangle{{0.0, 0.0}, {10.0, 5.0}};

TEST(Intensity, LengthInsideTheWindow) {
  EXPECT_DOUBLE_EQ(length_inside({{1, 1}, {4, 5}, {}}, rectangle), 5.0);
  EXPECT_DOUBLE_EQ(length_inside({{-3, 2}, {3, 2}, {}}, rectangle), 3.0);
  EXPECT_DOUBLE_EQ(length_inside({{5, -5}, {5, 15}, {}}, rectangle), 5.0);
  EXPECT_DOUBLE_EQ(length_inside({{-1, 4}, {1, 6}, {}}, rectangle), 0.0);  // past the corner
  EXPECT_DOUBLE_EQ(length_inside({{2, 6}, {8, 6}, {}}, rectangle), 0.0);
}

TEST(Intensity, OfFourTraces) {
  // Two vertical lines through the rectangle, a horizontal one whose centre is outside, one beyond.
  const Intensity i = measure_intensity(
      {{{2, -1}, {2, 6}, {}}, {{7, -1}, {7, 6}, {}}, {{-8, 2.2}, {4, 2.2}, {}}, {{0, 7}, {10, 7}, {}}},
      rectangle);
  EXPECT_EQ(i.traces, 3);
  EXPECT_DOUBLE_EQ(i.length, 14.0);
  EXPECT_DOUBLE_EQ(i.p21, 14.0 / 50.0);
  EXPECT_DOUBLE_EQ(i.p20, 2.0 / 50.0);
  EXPECT_DOUBLE_EQ(i.p10_across, 2.0 / 10.0);
  // Vertical scanlines at x = 1, 3, 5, 7 and 9; two of them cross the horizontal trace.
  EXPECT_DOUBLE_EQ(i.p10_down, 2.0 / 25.0);
}

}  // namespace
}  // namespace keyblock::rockmass
