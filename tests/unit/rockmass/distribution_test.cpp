#include "rockmass/distribution.h"

#include <gtest/gtest.h>

#include "verification/reference_distribution.h"

namespace keyblock::rockmass {
namespace {

using enum DistributionKind;

class EveryDistribution : public testing::TestWithParam<Distribution> {};

TEST_P(EveryDistribution, QuantileInvertsTheDistributionFunction) {
  for (double u = 0.001; u < 1.0; u += 0.001) {
    EXPECT_NEAR(verification::reference_cdf(GetParam(), quantile(GetParam(), u)), u, 1e-12) << u;
  }
}

TEST_P(EveryDistribution, SamplesArePositiveAndFinite) {
  for (const double u : {0x1p-53, 1e-12, 0.5, 1.0 - 1e-12, 1.0 - 0x1p-53}) {
    EXPECT_GE(quantile(GetParam(), u), 0.0) << u;
    EXPECT_TRUE(std::isfinite(quantile(GetParam(), u))) << u;
  }
}

TEST_P(EveryDistribution, MeanIsThatOfTheSamples) {
  constexpr int n = 1000000;  // midpoint rule; the tails of the unbounded ones limit its accuracy
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += quantile(GetParam(), (k + 0.5) / n);
  EXPECT_NEAR(sum / n, truncated_mean(GetParam()), 2e-5 * truncated_mean(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryDistribution,
                         testing::Values(Distribution{uniform, 0.3, 0.105}, Distribution{uniform, 0.3, 0.3},
                                         Distribution{normal, 1.8, 0.63}, Distribution{normal, 1.0, 1.5},
                                         Distribution{normal, 1.0, 0.01}, Distribution{lognormal, 1.8, 0.63},
                                         Distribution{lognormal, 0.4, 0.6},
                                         Distribution{exponential, 2.4, 0.0}));

TEST(Distribution, Constant) {
  EXPECT_EQ(quantile({constant, 0.7, 0.0}, 0.1), 0.7);
  EXPECT_EQ(quantile({normal, 0.7, 0.0}, 0.1), 0.7);
  EXPECT_EQ(quantile({constant, 0.0, 0.0}, 0.9), 0.0);
}

TEST(Distribution, UntruncatedMomentsAreThoseGiven) {
  for (const Distribution& d : {Distribution{uniform, 2.0, 0.7}, Distribution{lognormal, 2.0, 0.7}}) {
    constexpr int n = 1000000;
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < n; ++k) {
      const double x = quantile(d, (k + 0.5) / n);
      sum += x / n;
      squares += x * x / n;
    }
    EXPECT_NEAR(sum, 2.0, 1e-4);
    EXPECT_NEAR(std::sqrt(squares - sum * sum), 0.7, 1e-4);
  }
}

}  // namespace
}  // namespace keyblock::rockmass
