#include "overlap/overlap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "overlap/width.h"

namespace keyblock::overlap {
namespace {

Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

Polygon turned(Polygon polygon, double angle, Vec2 shift = {}) {
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    for (Vec2& p : polygon.ring(r)) {
      p = Vec2{std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y} +
          shift;
    }
  }
  return polygon;
}

Overlap of(const Polygon& a, const Polygon& b) {
  const std::vector<Polygon> blocks{a, b};
  return largest_overlap(blocks);
}

const Polygon unit_square = rectangle(0, 0, 1, 1);

TEST(Overlap, RectanglesInAnyPosition) {
  for (const double angle : {0.0, 0.3, 1.0, 2.5}) {
    for (const Vec2 shift : {Vec2{0, 0}, Vec2{-30, 70}, Vec2{4000, 1000}}) {
      const Overlap o =
          of(turned(unit_square, angle, shift), turned(rectangle(0.9, 0.2, 2, 0.7), angle, shift));
      EXPECT_EQ(o.block_a, 0);
      EXPECT_EQ(o.block_b, 1);
      EXPECT_NEAR(o.depth, 0.1, 1e-11);
      EXPECT_NEAR(o.area, 0.05, 1e-11);
      const Vec2 where = turned({{{0.95, 0.45}}, {}}, angle, shift).outer[0];
      EXPECT_NEAR(norm(o.where - where), 0.0, 1e-11);
    }
  }
}

TEST(Overlap, OrderOfTheBlocksDoesNotMatter) {
  const std::vector<Polygon> blocks{rectangle(5, 5, 6, 6), rectangle(0.9, 0, 2, 1), unit_square};
  const Overlap o = largest_overlap(blocks);
  EXPECT_EQ(o.block_a, 1);
  EXPECT_EQ(o.block_b, 2);
  EXPECT_NEAR(o.depth, 0.1, 1e-14);
}

// The corner of a square turned by 45° that reaches d into another: a triangle of height d and base 2d.
TEST(Overlap, CornerInAFace) {
  const Polygon diamond = turned(unit_square, std::numbers::pi / 4);
  for (const double d : {0.3, 1e-3, 1e-6, 1e-9}) {
    Polygon above = diamond;
    for (Vec2& p : above.outer) p += Vec2{0.5, 1.0 - d};
    const Overlap o = of(unit_square, above);
    EXPECT_NEAR(o.depth, d, 1e-15 + 1e-6 * d) << d;
    EXPECT_NEAR(o.area, d * d, 1e-16 + 1e-6 * d * d) << d;
  }
}

TEST(Overlap, RotatedSquaresOnOneCentreShareAnOctagon) {
  const Polygon square = rectangle(-1, -1, 1, 1);
  const Overlap o = of(square, turned(square, std::numbers::pi / 4));
  EXPECT_NEAR(o.depth, 2.0, 1e-14);
  EXPECT_NEAR(o.area, 8.0 * (std::numbers::sqrt2 - 1.0), 1e-14);
}

TEST(Overlap, SliversKeepTheirDigits) {
  for (const double d : {1e-3, 1e-6, 1e-9, 1e-11}) {
    for (const double angle : {0.0, 0.1, 1.234}) {
      const Overlap o =
          of(turned(unit_square, angle, {10, 10}), turned(rectangle(0.1, 1.0 - d, 0.8, 2), angle, {10, 10}));
      EXPECT_NEAR(o.depth, d, 2e-14) << d << ' ' << angle;
      EXPECT_NEAR(o.area, 0.7 * d, 2e-14);
    }
  }
}

TEST(Overlap, TouchingAndSeparateBlocksHaveNone) {
  const auto none = [](const Polygon& a, const Polygon& b) {
    const Overlap o = of(a, b);
    EXPECT_EQ(o.depth, 0.0);
    EXPECT_EQ(o.block_a, -1);
  };
  none(unit_square, rectangle(1, 0, 2, 1));        // an edge
  none(unit_square, rectangle(1, 0.25, 2, 0.75));  // a part of an edge
  none(unit_square, rectangle(1, 1, 2, 2));        // a corner
  none(unit_square, rectangle(3, 0, 4, 1));
  // Neighbours on a slanted joint with a vertex of one on the edge of the other, rounded.
  for (double angle = 0.0; angle < 3.0; angle += 0.01) {
    none(turned(unit_square, angle, {7, 3}), turned(rectangle(1, 1.0 / 3.0, 2, 2.0 / 3.0), angle, {7, 3}));
  }
  EXPECT_EQ(largest_overlap({}).block_a, -1);
}

const Polygon corner{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {}};  // an L

TEST(Overlap, BlockNestedInAConcaveCorner) {
  EXPECT_EQ(of(corner, rectangle(1, 1, 2, 2)).depth, 0.0);
  // Pressed into both faces: the shared region is an L of width d, though its hull is 0.7 m wide.
  for (const double d : {1e-3, 1e-6}) {
    const Overlap o = of(corner, rectangle(1 - d, 1 - d, 2, 2));
    EXPECT_NEAR(o.depth, d, 0.5 * d);
    EXPECT_NEAR(o.area, 2 * d + d * d, 1e-12);
  }
}

TEST(Overlap, HolesAreRespected) {
  Polygon ring = rectangle(0, 0, 3, 3);
  ring.holes.push_back({{1, 1}, {1, 2}, {2, 2}, {2, 1}});
  EXPECT_EQ(of(ring, rectangle(1, 1, 2, 2)).depth, 0.0);
  EXPECT_EQ(of(ring, rectangle(1.2, 1.2, 1.8, 1.8)).depth, 0.0);
  const double d = 1e-5;
  const Overlap island = of(ring, rectangle(1 - d, 1 - d, 2 + d, 2 + d));
  EXPECT_NEAR(island.depth, d, 0.5 * d);
  EXPECT_NEAR(island.area, 4 * d + 4 * d * d, 1e-12);
  const Overlap through = of(ring, rectangle(1.25, -1, 1.75, 4));
  EXPECT_NEAR(through.depth, 0.5, 1e-14);
  EXPECT_NEAR(through.area, 0.5, 1e-14);  // of one of the two regions
}

// Blocks that press on a frame from within are told from its hole, if that has no corner that sticks out.
TEST(Overlap, ConvexHolesBoundIt) {
  const double d = 1e-4;
  Polygon frame = rectangle(0, 0, 3, 3);
  frame.holes.push_back(
      {{1, 1}, {1, 1.5}, {1, 2}, {1.4, 2}, {2, 2}, {2, 1}});  // with places where joints end
  const Polygon one = rectangle(1 - d, 1 - d, 1.4, 1.5), other = rectangle(1.4 - 0.5 * d, 1, 2, 2);
  const Overlap largest = largest_overlap(std::vector<Polygon>{frame, one, other}, 0.0);
  EXPECT_NEAR(largest.depth, d, 1e-6);
  EXPECT_EQ(largest.block_a, 0);
  EXPECT_EQ(largest.block_b, 1);
  Polygon notched = rectangle(0, 0, 3, 3);
  notched.holes.push_back({{1, 1}, {1, 2}, {1.5, 2}, {1.5, 1.5}, {2, 1.5}, {2, 1}});
  EXPECT_NEAR(of(notched, rectangle(1.2, 1.2, 1.8, 1.8)).depth, 0.3, 1e-12);
}

TEST(Overlap, RegionsOfOnePairCountApart) {
  const Polygon fork{{{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {}};
  const std::vector<Polygon> blocks{fork, rectangle(-1, 1.9, 4, 3), rectangle(10, 10, 11, 11)};
  const auto all = all_overlaps(blocks, 0.0);
  ASSERT_EQ(all.size(), 2U);
  for (const Overlap& o : all) {
    EXPECT_NEAR(o.depth, 0.1, 1e-14);
    EXPECT_NEAR(o.area, 0.1, 1e-14);
  }
  EXPECT_TRUE(all_overlaps(blocks, 0.2).empty());
}

TEST(Overlap, BlocksThatCrossThemselvesAreStillSeen) {
  const Polygon bow_tie{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}, {}};
  const Overlap o = of(bow_tie, rectangle(1.5, -1, 3, 3));
  EXPECT_NEAR(o.depth, 0.5, 1e-14);
  EXPECT_NEAR(o.area, 0.5 * (1.0 + 2.0) * 0.5, 1e-12);
  EXPECT_EQ(of(bow_tie, rectangle(0.5, 1.6, 1.5, 3)).depth, 0.0);
}

// Oracle: clip one convex polygon by every edge line of the other.
Ring clipped(Ring ring, const Ring& by) {
  for (std::size_t k = 0; k < by.size(); ++k) {
    const Vec2 a = by[k], edge = by[(k + 1) % by.size()] - a;
    Ring kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 p = ring[i], q = ring[(i + 1) % ring.size()];
      const double sp = cross(edge, p - a), sq = cross(edge, q - a);
      if (sp >= 0) kept.push_back(p);
      if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) kept.push_back(lerp(p, q, sp / (sp - sq)));
    }
    ring = kept;
  }
  return ring;
}

// Oracle: extent in every direction.
double sampled_width(const Ring& ring) {
  double width = HUGE_VAL;
  for (int k = 0; k < 2000; ++k) {
    const Vec2 n{std::cos(std::numbers::pi * k / 2000), std::sin(std::numbers::pi * k / 2000)};
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Vec2 p : ring) {
      low = std::min(low, dot(n, p));
      high = std::max(high, dot(n, p));
    }
    width = std::min(width, high - low);
  }
  return width;
}

std::vector<Polygon> random_convex(std::mt19937& random, int count, double span) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Polygon> blocks;
  while (static_cast<int>(blocks.size()) < count) {
    const Vec2 centre{span * uniform(random), span * uniform(random)};
    Ring points;
    for (int k = 0; k < 8; ++k) points.push_back(centre + Vec2{uniform(random), uniform(random)});
    blocks.push_back({convex_hull(points), {}});
  }
  return blocks;
}

TEST(Overlap, RandomConvexPairsAgreeWithClipping) {
  std::mt19937 random(11);
  int overlapping = 0;
  for (int round = 0; round < 500; ++round) {
    const auto pair = random_convex(random, 2, 1.0);
    const Ring shared = clipped(pair[0].outer, pair[1].outer);
    const double expected_area = shared.size() < 3 ? 0.0 : signed_area(shared);
    const Overlap o = largest_overlap(pair);
    EXPECT_NEAR(o.area, expected_area, 1e-13);
    if (expected_area < 1e-12) continue;
    ++overlapping;
    const double width = sampled_width(shared);
    EXPECT_LE(o.depth, width * (1.0 + 1e-12));
    EXPECT_GE(o.depth, width - 2e-3);  // an angle apart by π/4000 at a length of 1.4
    EXPECT_LE(o.depth, hull_penetration(pair[0].outer, pair[1].outer) * (1.0 + 1e-12));
  }
  EXPECT_GT(overlapping, 200);
}

/// A star about a point, with corners that point inwards.
Polygon random_star(std::mt19937& random, Vec2 centre) {
  std::uniform_real_distribution<double> uniform(0.15, 1.0);
  Ring points;
  for (int k = 0; k < 9; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / 9;
    points.push_back(centre + uniform(random) * Vec2{std::cos(angle), std::sin(angle)});
  }
  return {points, {}};
}

// The bound by convex parts may leave out no region, nor be less than the depth of one that is convex.
TEST(Overlap, RandomStarsShareWhatTheirPartsDo) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> uniform(-1.2, 1.2);
  int apart = 0, thin = 0;
  for (int round = 0; round < 2000; ++round) {
    const Polygon a = random_star(random, {}), b = random_star(random, {uniform(random), uniform(random)});
    double expected = 0.0;
    for (const Ring& part : convex_parts(a)) {
      for (const Ring& other : convex_parts(b)) {
        const Ring shared = clipped(part, other);
        if (shared.size() >= 3) expected += signed_area(shared);
      }
    }
    const auto regions = all_overlaps(std::vector<Polygon>{a, b}, 0.0);
    double found = 0.0;
    for (const Overlap& o : regions) found += o.area;
    EXPECT_NEAR(found, expected, 1e-12);
    apart += expected == 0.0 && hull_penetration(convex_hull(a.outer), convex_hull(b.outer)) > 0.0 ? 1 : 0;
    // Alone, a region has the bound of its own pair of parts.
    if (regions.size() != 1 || convex_parts(a).size() * convex_parts(b).size() < 2) continue;
    double widest = 0.0;
    for (const Ring& part : convex_parts(a)) {
      for (const Ring& other : convex_parts(b)) {
        const Ring shared = convex_hull(clipped(part, other));
        if (shared.size() >= 3 && std::abs(signed_area(shared) - expected) < 1e-13)
          widest = convex_width(shared);
      }
    }
    if (widest == 0.0) continue;
    ++thin;
    EXPECT_NEAR(regions.front().depth, widest, 1e-12);
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(thin, 50);
}

TEST(Overlap, PruningLosesNothing) {
  std::mt19937 random(12);
  for (int round = 0; round < 20; ++round) {
    const auto blocks = random_convex(random, 40, 6.0);
    double deepest = 0.0;
    for (std::size_t a = 0; a < blocks.size(); ++a) {
      for (std::size_t b = a + 1; b < blocks.size(); ++b)
        deepest = std::max(deepest, of(blocks[a], blocks[b]).depth);
    }
    EXPECT_EQ(largest_overlap(blocks).depth, deepest);
    EXPECT_EQ(all_overlaps(blocks, 0.0).front().depth, deepest);
  }
}

TEST(Width, OfKnownShapes) {
  EXPECT_DOUBLE_EQ(convex_width(rectangle(0, 0, 3, 2).outer), 2.0);
  EXPECT_NEAR(convex_width(Ring{{0, 0}, {2, 0}, {1, std::sqrt(3.0)}}), std::sqrt(3.0), 1e-15);
  EXPECT_EQ(convex_width(Ring{{0, 0}, {1, 1}}), 0.0);
}

TEST(Width, HullDropsCollinearAndInnerPoints) {
  const Ring hull = convex_hull(Ring{{1, 1}, {0, 0}, {2, 0}, {1, 0}, {2, 2}, {0, 2}, {0, 0}});
  EXPECT_EQ(hull, (Ring{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_LT(convex_hull(Ring{{0, 0}, {1, 1}, {2, 2}}).size(), 3U);
}

TEST(Width, ConvexPartsCoverThePolygon) {
  Polygon ring = rectangle(0, 0, 3, 3);
  ring.holes.push_back({{1, 1}, {1, 2}, {2, 2}, {2, 1}});
  for (const Polygon& polygon : {ring, corner, unit_square}) {
    double sum = 0.0;
    const auto parts = convex_parts(polygon);
    for (const Ring& part : parts) {
      EXPECT_GT(signed_area(part), 0.0);
      EXPECT_NEAR(signed_area(convex_hull(part)), signed_area(part), 1e-14);
      sum += signed_area(part);
    }
    EXPECT_NEAR(sum, area(polygon), 1e-13);
  }
  EXPECT_EQ(convex_parts(unit_square).size(), 1U);
  EXPECT_LE(convex_parts(corner).size(), 3U);
}

// A wall of 30 × 30 blocks, each pressed a little into its neighbours, as in a compressed rock mass.
TEST(Overlap, NineHundredBlocksAreFast) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> press(0.0, 1e-6);
  std::vector<Polygon> blocks;
  for (int i = 0; i < 30; ++i) {
    for (int j = 0; j < 30; ++j) {
      const double x = i + 0.5 * (j % 2), y = j, d = press(random);
      blocks.push_back(
          {{{x - d, y - d}, {x + 0.3, y - d}, {x + 1 + d, y - d}, {x + 1 + d, y + 1 + d}, {x - d, y + 1 + d}},
           {}});
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const Overlap o = largest_overlap(blocks);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  RecordProperty("milliseconds", std::to_string(1e3 * seconds.count()));
  EXPECT_GT(o.depth, 1.5e-6);
  EXPECT_LT(o.depth, 2e-6);
#ifdef NDEBUG
  EXPECT_LT(seconds.count(), 0.5);  // usually 2 ms; the bound only catches a change of order
#endif
}

TEST(Union, CoversWhatOverlapsOnce) {
  const auto box = [](double x, double y, double w, double h) {
    return Polygon{{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, {}};
  };
  EXPECT_TRUE(union_of({}).empty());
  const Polygon one[] = {box(0, 0, 3, 2)};
  EXPECT_DOUBLE_EQ(area(union_of(one).front()), 6.0);
  // Twice the same, one that overlaps, one apart; four that leave a hole between them.
  const Polygon several[] = {box(0, 0, 3, 2), box(0, 0, 3, 2), box(2, 1, 2, 2), box(10, 0, 1, 1)};
  const auto parts = union_of(several);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(area(parts[0]) + area(parts[1]), 6.0 + 3.0 + 1.0, 1e-12);
  const Polygon frame[] = {box(0, 0, 3, 1), box(0, 2, 3, 1), box(0, 0, 1, 3), box(2, 0, 1, 3)};
  ASSERT_EQ(union_of(frame).size(), 1u);
  EXPECT_EQ(union_of(frame)[0].holes.size(), 1u);
  EXPECT_NEAR(area(union_of(frame)[0]), 8.0, 1e-12);
}

}  // namespace
}  // namespace keyblock::overlap
