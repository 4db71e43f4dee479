#include "geometry/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyblock {
namespace {

TEST(GaussLobatto, IsExactAndHasBothEnds) {
  for (int n = 2; n <= 25; ++n) {
    const LineRule& rule = gauss_lobatto(n);
    ASSERT_EQ(rule.points.size(), static_cast<std::size_t>(n));
    EXPECT_EQ(rule.points.front(), 0.0);
    EXPECT_EQ(rule.points.back(), 1.0);
    for (int degree = 0; degree <= 2 * n - 3; ++degree) {
      double sum = 0.0;
      for (std::size_t k = 0; k < rule.points.size(); ++k)
        sum += rule.weights[k] * std::pow(rule.points[k], degree);
      EXPECT_NEAR(sum * (degree + 1), 1.0, 1e-13) << n << ", degree " << degree;
    }
    for (std::size_t k = 1; k < rule.points.size(); ++k) EXPECT_LT(rule.points[k - 1], rule.points[k]);
  }
}

TEST(GaussLobatto, OfThreePointsIsSimpsons) {
  const LineRule& rule = gauss_lobatto(3);
  EXPECT_NEAR(rule.points[1], 0.5, 1e-16);
  EXPECT_NEAR(rule.weights[0], 1.0 / 6.0, 1e-16);
  EXPECT_NEAR(rule.weights[1], 4.0 / 6.0, 1e-16);
}

}  // namespace
}  // namespace keyblock
