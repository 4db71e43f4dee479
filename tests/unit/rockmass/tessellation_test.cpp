#include "rockmass/tessellation.h"

#include <gtest/gtest.h>

namespace keyblock::rockmass {
namespace {

using Pattern = Tessellation::Pattern;

double length_of(const std::vector<std::vector<Vec2>>& lines) {
  double sum = 0.0;
  for (const auto& line : lines) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) sum += norm(line[k + 1] - line[k]);
  }
  return sum;
}

TEST(Tessellation, BricksOfASquareHaveTheLengthOfTheirJoints) {
  Tessellation bricks{Pattern::brick, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}, 2.0, 0.5, 0.25, 0.0, 0};
  // 19 bed joints of 10 m within, and 20 courses: 10 of four head joints within, 10 of five. The outline has 40 m.
  const double within = 19 * 10.0 + 10 * (4 + 5) * 0.5;
  EXPECT_NEAR(length_of(tessellation_lines(bricks, 1, 0, 0)), within + 40.0, 1e-9);
  bricks.region = {{0, 0}, {10, 0}, {0, 10}};
  const double triangle = 10.0 + 10.0 + std::sqrt(200.0);
  double beds = 0.0;
  for (int k = 1; k < 20; ++k) beds += 10.0 - 0.5 * k;
  const auto lines = tessellation_lines(bricks, 1, 0, 0);
  double level = 0.0;
  for (const auto& line : lines) {
    if (line.size() == 2 && line[0].y == line[1].y) level += norm(line[1] - line[0]);
  }
  EXPECT_NEAR(level, beds, 1e-9);
  EXPECT_GT(length_of(lines), beds + triangle);
}

// Euler: N cells in a rectangle, all inner vertices of degree 3, have E edges within, of which each end is shared by three or lies on the rim.
TEST(Tessellation, VoronoiCellsDivideTheRegion) {
  const Tessellation voronoi{Pattern::voronoi, {{0, 0}, {12, 0}, {12, 8}, {0, 8}}, 1.0, 0.0, 0.0, 0.0, 5};
  EXPECT_EQ(expected_count(voronoi), 96.0);
  const auto lines = tessellation_lines(voronoi, 7, 0, 0);
  std::size_t inner = 0, rim = 0;
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
    for (const Vec2 p : lines[k]) {
      const bool on_rim = p.x < 1e-9 || p.x > 12 - 1e-9 || p.y < 1e-9 || p.y > 8 - 1e-9;
      ++(on_rim ? rim : inner);
    }
  }
  ASSERT_EQ(inner % 3, 0U);
  // V − E + F = 1 with the four corners and the edges of the rim.
  const auto vertices = static_cast<long>(inner / 3 + rim + 4),
             edges = static_cast<long>(lines.size() - 1 + rim + 4);
  EXPECT_EQ(vertices - edges + 96, 1);
  EXPECT_EQ(tessellation_lines(voronoi, 7, 0, 0), lines);
  EXPECT_NE(tessellation_lines(voronoi, 7, 1, 0), lines);
  EXPECT_NE(tessellation_lines(voronoi, 7, 0, 1), lines);
}

}  // namespace
}  // namespace keyblock::rockmass
