#include "geometry/compact_rule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/moments.h"

namespace keyblock {
namespace {

/// Largest error of ∫ ((x − c)/h)^i ((y − c)/h)^j dA / A up to the degree.
double largest_error(const Polygon& polygon, const std::vector<WeightedPoint>& rule, int degree) {
  const Vec2 centre = centroid(polygon);
  const double scale = 0.5 * norm(bounds(polygon).size());
  const Moments exact(polygon, centre, scale, degree);
  double largest = 0.0;
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; i + j <= degree; ++j) {
      double sum = 0.0;
      for (const WeightedPoint& w : rule) {
        const Vec2 x = (w.point - centre) / scale;
        sum += w.weight * std::pow(x.x, i) * std::pow(x.y, j);
      }
      largest = std::max(largest, std::abs(sum - exact(i, j)) / area(polygon));
    }
  }
  return largest;
}

Polygon convex_polygon(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(0.0, 6.283);
  std::vector<double> angles(3 + random() % 6);
  for (double& a : angles) a = angle(random);
  std::sort(angles.begin(), angles.end());
  Polygon polygon;
  for (const double a : angles)
    polygon.outer.push_back({5.0 + std::cos(a), -3.0 + 0.2 * std::sin(a) + 0.3 * std::cos(a)});
  return polygon;
}

TEST(CompactRule, HasAsManyPointsAsAreComputedAtOnce) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const Polygon polygon = convex_polygon(random);
    if (area(polygon) < 1e-3) continue;
    const auto rule = compact_rule(polygon, 4);
    EXPECT_EQ(rule.size(), 8U) << trial;
    EXPECT_LT(largest_error(polygon, rule, 4), 1e-14) << trial;
    const Box box = bounds(polygon), around = box.grown(0.1 * norm(box.size()));
    for (const WeightedPoint& w : rule) {
      EXPECT_GT(w.weight, 0.0) << trial;
      EXPECT_TRUE(around.contains(w.point)) << trial;
    }
  }
}

TEST(CompactRule, HoldsForHigherDegreesAndAnyShape) {
  // Convex, not star-shaped, with a hole.
  const Polygon shapes[] = {
      {{{0.1, 0.0}, {0.7, 0.1}, {0.9, 0.5}, {0.4, 0.8}, {0.0, 0.4}}, {}},
      {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}}, {}},
      {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{{0.4, 0.4}, {0.4, 0.6}, {0.6, 0.6}, {0.6, 0.4}}}},
  };
  for (const Polygon& shape : shapes) {
    for (const auto& [degree, points] : {std::pair{2, 8U}, {4, 8U}, {8, 24U}, {12, 40U}}) {
      const auto rule = compact_rule(shape, degree);
      EXPECT_EQ(rule.size(), points) << degree;
      EXPECT_LT(largest_error(shape, rule, degree), 1e-14) << degree;
      for (const WeightedPoint& w : rule) EXPECT_GT(w.weight, 0.0) << degree;
    }
  }
}

// Moments along and across a plank, which in x and y all but vanish beside each other: ∫ s^i t^j dA = A / ((i + 1)(j + 1)).
TEST(CompactRule, KeepsItsDigitsForThinAndInclinedPlanks) {
  for (const double width : {1.0, 0.1, 0.01, 0.001}) {
    const Vec2 along{1.0, 0.8}, across = width * perpendicular(along);
    const Polygon plank{{{}, along, along + across, across}, {}};
    for (const int degree : {4, 8, 12}) {
      const auto rule = compact_rule(plank, degree);
      EXPECT_LE(rule.size(), 40U) << width << " " << degree;
      for (int i = 0; i <= degree; ++i) {
        for (int j = 0; i + j <= degree; ++j) {
          double sum = 0.0;
          for (const WeightedPoint& w : rule) {
            const double s = dot(w.point, along) / squared_norm(along),
                         t = dot(w.point, across) / squared_norm(across);
            sum += w.weight * std::pow(s, i) * std::pow(t, j);
          }
          EXPECT_NEAR(sum / area(plank), 1.0 / ((i + 1) * (j + 1)), 1e-14 / width)
              << width << ": s^" << i << " t^" << j;
        }
      }
    }
  }
}

TEST(CompactRule, LeavesOtherDegreesToTheWholeRule) {
  const Polygon square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}};
  for (const int degree : {0, 1, 16})
    EXPECT_EQ(compact_rule(square, degree).size(), polygon_rule(square, degree).size());
}

}  // namespace
}  // namespace keyblock
