#include "statistics/sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"
#include "statistics/curves.h"
#include "statistics/distributions.h"
#include "statistics/proportion.h"

namespace keyblock::statistics {
namespace {

TEST(Sample, MeanAndDeviationOfKnownNumbers) {
  const std::vector<double> x{2, 4, 4, 4, 5, 5, 7, 9};
  EXPECT_DOUBLE_EQ(mean(x), 5.0);
  EXPECT_DOUBLE_EQ(standard_deviation(x), std::sqrt(32.0 / 7.0));
}

// 3 × 1.1 / 3 is not 1.1 in floating point.
TEST(Sample, EqualNumbersHaveNoSpread) {
  for (const double value : {1.1, 0.3, -7e-9}) {
    for (std::size_t n = 2; n < 12; ++n) {
      const std::vector<double> x(n, value);
      EXPECT_EQ(mean(x), value);
      EXPECT_EQ(standard_deviation(x), 0.0);
    }
  }
}

TEST(Sample, TooFewNumbersGiveNone) {
  const std::vector<double> one{3.0};
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_TRUE(std::isnan(standard_deviation({})));
  EXPECT_TRUE(std::isnan(standard_deviation(one)));
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_EQ(mean(one), 3.0);
  EXPECT_EQ(quantile(one, 0.05), 3.0);
  EXPECT_EQ(quantile(one, 1.0), 3.0);
}

// R: quantile(c(1, 2, 4, 8, 16), c(0, .05, .25, .4, .5, .95, 1), type = 7)
TEST(Sample, QuantilesAreOfTypeSeven) {
  const std::vector<double> x{1, 2, 4, 8, 16};
  const std::vector<std::pair<double, double>> expected{{0.0, 1.0}, {0.05, 1.2},  {0.25, 2.0}, {0.4, 3.2},
                                                        {0.5, 4.0}, {0.95, 14.4}, {1.0, 16.0}};
  for (const auto& [p, q] : expected) EXPECT_NEAR(quantile(x, p), q, 1e-12) << p;
}

TEST(Distributions, NormalCdfInvertsItsQuantile) {
  for (const double p : {1e-12, 0.001, 0.3, 0.5, 0.9, 0.999})
    EXPECT_NEAR(normal_cdf(inverse_normal_cdf(p)) / p, 1.0, 1e-12);
}

// Two-sided 95 % and 99 % of printed tables.
TEST(Distributions, StudentMatchesTables) {
  const std::vector<std::pair<int, double>> at_95{{1, 12.7062}, {2, 4.30265},  {3, 3.18245},  {4, 2.77645},
                                                  {5, 2.57058}, {10, 2.22814}, {30, 2.04227}, {120, 1.97993}};
  for (const auto& [n, t] : at_95) EXPECT_NEAR(student_t(0.95, n), t, 3e-5 * t) << n;
  EXPECT_NEAR(student_t(0.95, 1), 12.7062047364, 1e-8);
  EXPECT_NEAR(student_t(0.95, 2), 4.30265272975, 1e-9);
  EXPECT_NEAR(student_t(0.90, 5), 2.01504837333, 1e-9);
  EXPECT_NEAR(student_t(0.95, 9), 2.26215716280, 1e-9);
  EXPECT_NEAR(student_t(0.99, 30), 2.74999565357, 1e-9);
  EXPECT_NEAR(student_t(0.95, 1'000'000), 1.95996634, 1e-6);
  EXPECT_NEAR(student_t(0.0, 3), 0.0, 1e-6);
}

// Brown, Cai & DasGupta's formula by hand: 1 of 10 at 95 %, and the ends.
TEST(Proportion, WilsonOfKnownCounts) {
  const Estimate tenth = proportion(1, 10, 0.95);
  EXPECT_DOUBLE_EQ(tenth.value, 0.1);
  EXPECT_NEAR(tenth.low, 0.017876, 1e-6);
  EXPECT_NEAR(tenth.high, 0.404150, 1e-6);
  const Estimate none = proportion(0, 20, 0.95);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 0.161125, 1e-6);  // z²/(n + z²)
  const Estimate all = proportion(20, 20, 0.95);
  EXPECT_NEAR(all.low, 1.0 - 0.161125, 1e-6);
  EXPECT_EQ(all.high, 1.0);
  const Estimate empty = proportion(0, 0, 0.95);
  EXPECT_TRUE(std::isnan(empty.value));
  EXPECT_EQ(empty.low, 0.0);
  EXPECT_EQ(empty.high, 1.0);
}

// Exact coverage over the binomial distribution: near what is asked for, at every p that matters.
TEST(Proportion, OfFewerIndependentDrawsIsWider) {
  const Estimate twenty = proportion(10, 20, 0.95), ten = share_of_independent(0.5, 10.0, 0.95);
  EXPECT_DOUBLE_EQ(ten.low, proportion(5, 10, 0.95).low);
  EXPECT_DOUBLE_EQ(ten.high, proportion(5, 10, 0.95).high);
  EXPECT_LT(ten.low, twenty.low);
  EXPECT_EQ(share_of_independent(1.0, 4.0, 0.95).high, 1.0);
  EXPECT_EQ(share_of_independent(0.0, 4.0, 0.95).low, 0.0);
}

TEST(Proportion, CoversAsOftenAsItSays) {
  const int n = 40;
  for (const double p : {0.1, 0.3, 0.5, 0.8}) {
    double covered = 0.0, probability = std::pow(1.0 - p, n);
    for (int k = 0; k <= n; ++k) {
      const Estimate e = proportion(static_cast<std::size_t>(k), n, 0.95);
      if (e.low <= p && p <= e.high) covered += probability;
      probability *= p / (1.0 - p) * (n - k) / (k + 1.0);
    }
    EXPECT_GT(covered, 0.92) << p;
    EXPECT_LT(covered, 0.985) << p;
  }
}

TEST(RunningMean, EndsAtTheMeanWithStudentsBand) {
  const std::vector<double> x{2, 4, 4, 4, 5, 5, 7, 9};
  const RunningMean running = running_mean(x, 0.95);
  ASSERT_EQ(running.n.size(), 8U);
  EXPECT_EQ(running.n.front(), 1U);
  EXPECT_EQ(running.mean.front().value, 2.0);
  EXPECT_TRUE(std::isnan(running.mean.front().low));
  EXPECT_NEAR(running.mean[1].high, 3.0 + 12.7062 * std::sqrt(2.0) / std::sqrt(2.0), 1e-3);
  EXPECT_DOUBLE_EQ(running.mean.back().value, 5.0);
  const double reach = 2.364624 * std::sqrt(32.0 / 7.0 / 8.0);
  EXPECT_NEAR(running.mean.back().low, 5.0 - reach, 1e-4);
  EXPECT_TRUE(running_mean({}, 0.95).n.empty());
}

TEST(RunningMean, IsThinnedEvenlyAndKeepsItsEnds) {
  std::vector<double> x(1001);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = static_cast<double>(k);
  const RunningMean running = running_mean(x, 0.95, 101);
  ASSERT_EQ(running.n.size(), 101U);
  EXPECT_EQ(running.n.front(), 1U);
  EXPECT_EQ(running.n[1], 11U);
  EXPECT_DOUBLE_EQ(running.mean[1].value, 5.0);
  EXPECT_EQ(running.n.back(), 1001U);
  EXPECT_DOUBLE_EQ(running.mean.back().value, 500.0);
}

TEST(Exceedance, IsTheShareAboveEachValue) {
  const std::vector<double> x{0, 0, 0, 1, 2, 2, 5, 9, 9, 10};
  const ExceedanceCurve curve = exceedance_curve(x, 0.95);
  EXPECT_EQ(curve.value, (std::vector<double>{0, 1, 2, 5, 9, 10}));
  const std::vector<double> above{0.7, 0.6, 0.4, 0.3, 0.1, 0.0};
  for (std::size_t k = 0; k < above.size(); ++k) {
    EXPECT_DOUBLE_EQ(curve.above[k].value, above[k]);
    EXPECT_LE(curve.above[k].low, above[k]);
    EXPECT_GT(curve.above[k].high, above[k]);
  }
  EXPECT_TRUE(exceedance_curve({}, 0.95).value.empty());
  std::vector<double> many(5000);
  for (std::size_t k = 0; k < many.size(); ++k) many[k] = static_cast<double>(k);
  const ExceedanceCurve thinned = exceedance_curve(many, 0.95, 100);
  ASSERT_EQ(thinned.value.size(), 100U);
  EXPECT_EQ(thinned.value.front(), 0.0);
  EXPECT_EQ(thinned.above.back().value, 0.0);
}

}  // namespace
}  // namespace keyblock::statistics
