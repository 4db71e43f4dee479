#include "geometry/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyblock {
namespace {

double integral(const std::vector<WeightedPoint>& rule, int i, int j) {
  double sum = 0.0;
  for (const WeightedPoint& w : rule) sum += w.weight * std::pow(w.point.x, i) * std::pow(w.point.y, j);
  return sum;
}

// A convex block, one that is not star-shaped (with negative weights), a slanted sliver, and one with a hole.
const Polygon shapes[] = {
    {{{0.1, 0.0}, {0.7, 0.1}, {0.9, 0.5}, {0.4, 0.8}, {0.0, 0.4}}, {}},
    {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}}, {}},
    {{{0, 0}, {1, 0.99}, {1.001, 1.0}, {0.0, 0.002}}, {}},
    {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{{0.4, 0.4}, {0.6, 0.4}, {0.6, 0.6}, {0.4, 0.6}}}},
};

TEST(Quadrature, ThinnedRulesKeepAllMomentsWithFewerPoints) {
  for (const Polygon& shape : shapes) {
    for (const int degree : {2, 4, 6, 8}) {
      const auto whole = polygon_rule(shape, degree), thin = thinned_rule(whole, degree);
      EXPECT_LE(thin.size(), static_cast<std::size_t>((degree + 1) * (degree + 2) / 2)) << degree;
      double total = 0.0;
      for (const WeightedPoint& w : whole) total += std::abs(w.weight);
      for (int i = 0; i <= degree; ++i) {
        for (int j = 0; i + j <= degree; ++j) {
          EXPECT_NEAR(integral(thin, i, j), integral(whole, i, j), 1e-12 * total * std::pow(3.0, i + j))
              << degree << ": x^" << i << " y^" << j;
        }
      }
    }
  }
}

TEST(Quadrature, ThinnedRulesOfConvexShapesHavePositiveWeights) {
  for (const WeightedPoint& w : thinned_rule(polygon_rule(shapes[0], 4), 4)) EXPECT_GT(w.weight, 0.0);
}

TEST(Quadrature, RulesThatAreSmallEnoughStay) {
  const auto whole = polygon_rule(shapes[0], 1);
  EXPECT_EQ(thinned_rule(whole, 1).size(), whole.size());
  const auto high = polygon_rule(shapes[0], 20);
  EXPECT_EQ(thinned_rule(high, 20).size(), high.size());
}

}  // namespace
}  // namespace keyblock
