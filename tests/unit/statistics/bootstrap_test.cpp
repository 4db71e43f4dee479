#include "statistics/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "statistics/sample.h"

namespace keyblock::statistics {
namespace {

const std::vector<double> quartiles{0.25, 0.5, 0.75};

std::vector<double> exponential(std::uint64_t seed, std::size_t n) {
  const RandomStream stream(seed, 0, 0, 0);
  std::vector<double> x(n);
  for (std::size_t k = 0; k < n; ++k) x[k] = -std::log(stream.uniform(static_cast<std::uint32_t>(k)));
  std::sort(x.begin(), x.end());
  return x;
}

TEST(Resamples, AreAscendingDrawsWithReplacementThatDoNotChange) {
  const Resamples draws(50, 400);
  std::vector<double> times(50, 0.0);
  for (std::size_t r = 0; r < draws.count(); ++r) {
    const auto ranks = draws.ranks(r);
    ASSERT_EQ(ranks.size(), 50U);
    EXPECT_TRUE(std::is_sorted(ranks.begin(), ranks.end()));
    for (const std::uint32_t k : ranks) times.at(k) += 1.0;
  }
  for (const double t : times) EXPECT_NEAR(t, 400.0, 5.0 * std::sqrt(400.0));
  const Resamples again(50, 400);
  for (std::size_t r = 0; r < 400; ++r)
    EXPECT_TRUE(std::equal(draws.ranks(r).begin(), draws.ranks(r).end(), again.ranks(r).begin()));
}

// The resampled statistics of ranks are those of the sorted resample, computed the slow way.
TEST(Describe, MatchesSlowResampling) {
  const std::vector<double> x = exponential(3, 17);
  const Resamples draws(17, 300);
  std::vector<double> medians;
  for (std::size_t r = 0; r < 300; ++r) {
    std::vector<double> sample;
    for (const std::uint32_t k : draws.ranks(r)) sample.push_back(x[k]);
    std::sort(sample.begin(), sample.end());
    medians.push_back(quantile(sample, 0.5));
  }
  const Interval slow = percentile_interval(medians, 0.9);
  const Description fast = describe(x, quartiles, draws, 0.9);
  EXPECT_DOUBLE_EQ(fast.quantiles[1].low, slow.low);
  EXPECT_DOUBLE_EQ(fast.quantiles[1].high, slow.high);
  EXPECT_EQ(fast.quantiles[1].value, quantile(x, 0.5));
  EXPECT_EQ(fast.min, x.front());
  EXPECT_EQ(fast.max, x.back());
}

TEST(Describe, SmallSamplesSayWhatTheyCan) {
  const Description none = describe({}, quartiles, Resamples(0), 0.95);
  EXPECT_EQ(none.n, 0U);
  EXPECT_TRUE(std::isnan(none.mean.value));
  ASSERT_EQ(none.quantiles.size(), 3U);
  EXPECT_TRUE(std::isnan(none.quantiles[0].value));
  const std::vector<double> single{2.0};
  const Description one = describe(single, quartiles, Resamples(1), 0.95);
  EXPECT_EQ(one.mean.value, 2.0);
  EXPECT_TRUE(std::isnan(one.mean.low));
  EXPECT_TRUE(std::isnan(one.standard_deviation.value));
  EXPECT_EQ(one.quantiles[2].value, 2.0);
  EXPECT_TRUE(std::isnan(one.quantiles[2].low));
  const std::vector<double> pair{1.0, 3.0};
  const Description two = describe(pair, quartiles, Resamples(2), 0.95);
  EXPECT_EQ(two.mean.value, 2.0);
  EXPECT_TRUE(std::isnan(two.mean.low));
  EXPECT_DOUBLE_EQ(two.standard_deviation.value, std::sqrt(2.0));
  EXPECT_EQ(two.quantiles[1].value, 2.0);
  const std::vector<double> five{1.0, 2.0, 3.0, 4.0, 6.0};
  const Description enough = describe(five, quartiles, Resamples(5), 0.95);
  EXPECT_LT(enough.mean.low, 3.2);
  EXPECT_GT(enough.mean.high, 3.2);
  EXPECT_LT(enough.standard_deviation.low, enough.standard_deviation.value);
}

TEST(Describe, EqualNumbersAreCertain) {
  const std::vector<double> x(12, 0.25);
  const Description d = describe(x, quartiles, Resamples(12), 0.95);
  EXPECT_EQ(d.mean.low, 0.25);
  EXPECT_EQ(d.mean.high, 0.25);
  EXPECT_EQ(d.standard_deviation.value, 0.0);
  EXPECT_EQ(d.standard_deviation.high, 0.0);
}

// Where most values are zero some resamples hold nothing else: their mean is zero, not rounding.
TEST(Describe, ZerosStayZeros) {
  std::vector<double> x(30, 0.0);
  x.back() = 0.3;
  const Description d = describe(x, quartiles, Resamples(30), 0.95);
  EXPECT_EQ(d.mean.low, 0.0);
  EXPECT_EQ(d.standard_deviation.low, 0.0);
  EXPECT_EQ(d.quantiles[2].high, 0.0);
}

// A skew sample of 40: the interval of the mean must hold the true one about as often as it says, and miss on both sides.
TEST(Describe, IntervalsCoverAsOftenAsTheySay) {
  const Resamples draws(40, 600);
  const int trials = 600;
  int mean_covered = 0, median_covered = 0, below = 0;
  for (int t = 0; t < trials; ++t) {
    const Description d =
        describe(exponential(static_cast<std::uint64_t>(1000 + t), 40), quartiles, draws, 0.95);
    mean_covered += d.mean.low <= 1.0 && 1.0 <= d.mean.high ? 1 : 0;
    below += d.mean.high < 1.0 ? 1 : 0;
    const double median = std::log(2.0);
    median_covered += d.quantiles[1].low <= median && median <= d.quantiles[1].high ? 1 : 0;
  }
  EXPECT_GT(mean_covered, 0.905 * trials);
  EXPECT_LT(mean_covered, 0.985 * trials);
  EXPECT_GT(median_covered, 0.905 * trials);
  EXPECT_LT(median_covered, 0.985 * trials);
  EXPECT_LT(below, 0.06 * trials);
}

// For a symmetric replicate distribution and no acceleration both intervals agree.
TEST(Bca, WithoutSkewIsThePercentileInterval) {
  std::vector<double> replicates;
  for (int k = -500; k <= 500; ++k) replicates.push_back(k);
  std::vector<double> copy = replicates;
  const std::vector<double> left_out{-1.0, 0.0, 1.0};
  const Interval bca = bca_interval(replicates, 0.0, left_out, 0.9);
  const Interval percentile = percentile_interval(copy, 0.9);
  EXPECT_NEAR(bca.low, percentile.low, 1e-9);
  EXPECT_NEAR(bca.high, percentile.high, 1e-9);
}

}  // namespace
}  // namespace keyblock::statistics
