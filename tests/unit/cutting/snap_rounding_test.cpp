#include "cutting/snap_rounding.h"

#include <gtest/gtest.h>

#include <random>

namespace keyblock::cutting {
namespace {

SourceLine line(GridPoint a, GridPoint b) {
  return {a, b, {}};
}

/// Lines on a small grid, so that many pass within half a step of ends and crossings of others, and some overlap.
std::vector<SourceLine> random_lines(std::uint32_t seed, int count, std::int64_t extent) {
  std::mt19937 random(seed);
  const auto coordinate = [&] {
    return static_cast<std::int64_t>(random() % static_cast<std::uint32_t>(extent));
  };
  std::vector<SourceLine> lines;
  while (static_cast<int>(lines.size()) < count) {
    const GridPoint a{coordinate(), coordinate()}, b{coordinate(), coordinate()};
    if (!(a == b)) lines.push_back(line(a, b));
  }
  return lines;
}

// Points are in order of y, then x.
TEST(SnapRounding, CutsAtCrossingsRoundedToTheGrid) {
  const std::vector<Segment> expected{
      {{{0, 0}, {5, 5}}}, {{{9, 0}, {5, 5}}}, {{{5, 5}, {0, 9}}}, {{{5, 5}, {9, 9}}}};
  EXPECT_EQ(snap_round({line({0, 0}, {9, 9}), line({0, 9}, {9, 0})}), expected);
}

TEST(SnapRounding, LinesPassThroughEndsWithinHalfAStep) {
  const std::vector<Segment> expected{{{{0, 0}, {5, 1}}}, {{{5, 1}, {10, 1}}}, {{{5, 1}, {5, 8}}}};
  EXPECT_EQ(snap_round({line({0, 0}, {10, 1}), line({5, 1}, {5, 8})}), expected);
}

TEST(SnapRounding, LinesThatOverlapAreOne) {
  const std::vector<Segment> expected{{{{0, 0}, {2, 0}}}, {{{2, 0}, {6, 0}}}, {{{6, 0}, {9, 0}}}};
  EXPECT_EQ(snap_round({line({0, 0}, {6, 0}), line({9, 0}, {2, 0})}), expected);
}

TEST(SnapRounding, SameAsByUnion) {
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    const std::vector<SourceLine> lines =
        random_lines(seed, 5 + static_cast<int>(seed), seed % 2 == 0 ? 40 : 100'000);
    EXPECT_EQ(snap_round(lines), snap_round_by_union(lines)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace keyblock::cutting
