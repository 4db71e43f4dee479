#include "statistics/order_statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"

namespace keyblock::statistics {
namespace {

std::vector<double> first_numbers(std::size_t n) {
  std::vector<double> numbers(n);
  for (std::size_t k = 0; k < n; ++k) numbers[k] = static_cast<double>(k + 1);
  return numbers;
}

// Ranks of tables: Conover (1999), "Practical Nonparametric Statistics", and sums of binomial probabilities.
TEST(QuantileInterval, HasTheRanksOfTables) {
  const auto check = [](std::size_t n, double p, double low, double high) {
    const Interval interval = quantile_interval(first_numbers(n), p, 0.95);
    EXPECT_EQ(interval.low, low) << n << ' ' << p;
    EXPECT_EQ(interval.high, high) << n << ' ' << p;
  };
  check(6, 0.5, 1.0, 6.0);
  check(10, 0.5, 2.0, 9.0);
  check(20, 0.5, 6.0, 15.0);
  check(100, 0.5, 40.0, 61.0);
  check(20, 0.25, 2.0, 10.0);
  check(100, 0.95, 90.0, 100.0);
  check(5, 0.5, -HUGE_VAL, HUGE_VAL);
  check(20, 0.95, 17.0, HUGE_VAL);
  check(20, 0.05, -HUGE_VAL, 4.0);
  check(0, 0.5, -HUGE_VAL, HUGE_VAL);
}

// It holds the quantile at least as often as it says, whatever the distribution.
TEST(QuantileInterval, HoldsTheQuantileOfSkewedDraws) {
  constexpr int draws = 4000, n = 15;
  for (const double p : {0.25, 0.5}) {
    const double known = -std::log(1.0 - p);
    int held = 0;
    for (int k = 0; k < draws; ++k) {
      std::vector<double> sample(n);
      for (int i = 0; i < n; ++i)
        sample[static_cast<std::size_t>(i)] =
            -std::log(1.0 - RandomStream(7, 0, 0, 0).uniform(static_cast<std::uint32_t>(k * n + i)));
      std::sort(sample.begin(), sample.end());
      const Interval interval = quantile_interval(sample, p, 0.9);
      held += interval.low <= known && known <= interval.high;
    }
    EXPECT_GE(held, 0.89 * draws) << p;
    EXPECT_LE(held, 0.98 * draws) << p;
  }
}

}  // namespace
}  // namespace keyblock::statistics
