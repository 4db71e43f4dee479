#include "statistics/dependence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random.h"

namespace keyblock::statistics {
namespace {

/// Independent standard normal numbers.
std::vector<double> normal(std::uint32_t which, std::size_t n, std::uint32_t sample = 0) {
  const RandomStream stream(11, sample, which, 0);
  std::vector<double> x;
  for (std::size_t k = 0; k < n; ++k)
    x.push_back(inverse_normal_cdf(stream.uniform(static_cast<std::uint32_t>(k))));
  return x;
}

std::vector<double> sum(double a, const std::vector<double>& x, double b, const std::vector<double>& y) {
  std::vector<double> f;
  for (std::size_t k = 0; k < x.size(); ++k) f.push_back(a * x[k] + b * y[k]);
  return f;
}

/// F = a x + b y with x and y independent: S_x = a²/(a² + b²), exact.
TEST(FirstOrderIndex, OfALinearModelIsExactWithinItsInterval) {
  for (const auto& [a, b] : {std::pair{1.0, 2.0}, {2.0, 1.0}, {1.0, 0.2}, {0.0, 1.0}}) {
    const double exact = a * a / (a * a + b * b);
    int held = 0;
    double mean_of_all = 0.0;
    constexpr int samples = 60;
    for (std::uint32_t s = 0; s < samples; ++s) {
      const std::vector<double> x = normal(1, 100, s), y = normal(2, 100, s);
      const Estimate index = first_order_index(x, sum(a, x, b, y), 0.95);
      held += index.low <= exact && exact <= index.high ? 1 : 0;
      mean_of_all += index.value / samples;
    }
    EXPECT_GE(held, 52) << exact;  // of 60: below with a probability of 1 % where 95 % hold
    EXPECT_NEAR(mean_of_all, exact, 0.03);
  }
}

TEST(FirstOrderIndex, SeesWhatIsNotMonotone) {
  const std::vector<double> x = normal(1, 200), y = normal(2, 200);
  std::vector<double> f;
  for (std::size_t k = 0; k < x.size(); ++k) f.push_back(x[k] * x[k] + 0.1 * y[k]);
  EXPECT_GT(first_order_index(x, f, 0.95).value, 0.9);
  const Estimate rho = rank_correlation(x, f, 0.95);
  EXPECT_LT(rho.low, 0.0);
  EXPECT_GT(rho.high, 0.0);
}

TEST(FirstOrderIndex, OfTooFewOrOfOneValueIsNotKnown) {
  const std::vector<double> x = normal(1, 19), same(30, 4.0), y = normal(2, 30);
  EXPECT_TRUE(std::isnan(first_order_index(x, x, 0.95).value));
  EXPECT_TRUE(std::isnan(first_order_index(same, y, 0.95).value));
  EXPECT_TRUE(std::isnan(first_order_index(y, same, 0.95).value));
  EXPECT_TRUE(std::isnan(rank_correlation(y, same, 0.95).value));
}

/// Of normal numbers with a correlation r: ρ = 6/π asin(r/2).
TEST(RankCorrelation, OfNormalNumbersIsExactWithinItsInterval) {
  const double r = 1.0 / std::sqrt(5.0), exact = 6.0 / std::numbers::pi * std::asin(0.5 * r);
  int held = 0;
  for (std::uint32_t s = 0; s < 60; ++s) {
    const std::vector<double> x = normal(1, 80, s), y = normal(2, 80, s);
    const Estimate rho = rank_correlation(x, sum(1.0, x, 2.0, y), 0.95);
    held += rho.low <= exact && exact <= rho.high ? 1 : 0;
  }
  EXPECT_GE(held, 52);
}

/// Ranks 1, 2.5, 2.5, 4 and 1, 2, 3, 4: 4.5/√(4.5 · 5).
TEST(RankCorrelation, GivesEqualValuesTheMeanOfTheirRanks) {
  const std::vector<double> x{1.0, 7.0, 7.0, 9.0}, y{0.1, 0.2, 0.3, 0.4};
  EXPECT_NEAR(rank_correlation(x, y, 0.95).value, 4.5 / std::sqrt(4.5 * 5.0), 1e-12);
  EXPECT_EQ(rank_correlation(y, y, 0.95).value, 1.0);
}

}  // namespace
}  // namespace keyblock::statistics
