#include "statistics/split.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

namespace keyblock::statistics {
namespace {

TEST(BivariateNormal, IsThatOfKnownPlaces) {
  EXPECT_NEAR(bivariate_normal_cdf(0.0, 0.0, 0.5), 1.0 / 3.0, 1e-10);
  EXPECT_NEAR(bivariate_normal_cdf(1.0, -0.5, 0.6), 0.301321916, 1e-8);
  EXPECT_NEAR(bivariate_normal_cdf(-1.2, 0.3, -0.4), 0.039589702, 1e-8);
}

// 400 rock masses under 30 records, two each, of σ 0.4, 0.3 and 0.2: ρ is 0.55 and 0.31.
TEST(SharedCorrelations, RecoverWhatPairsWereMadeFrom) {
  const std::vector<double> thresholds{-1.5, -0.7, 0.0, 0.7, 1.5};
  const double beta = std::sqrt(0.29);
  std::vector<Pair> pairs;
  for (int rock = 0; rock < 400; ++rock) {
    for (int q = 0; q < 2; ++q) {
      const int record = (rock + q * (1 + rock / 30 % 29)) % 30;
      const auto draw = [](std::uint32_t who, std::uint32_t what) {
        return inverse_normal_cdf(RandomStream(8, who, what, 0).uniform(0));
      };
      const double capacity = 0.4 * draw(static_cast<std::uint32_t>(rock), 1) +
                              0.3 * draw(static_cast<std::uint32_t>(record), 2) +
                              0.2 * draw(static_cast<std::uint32_t>(30 * rock + record), 3);
      std::size_t first = 0;
      while (first < thresholds.size() && beta * thresholds[first] <= capacity) ++first;
      pairs.push_back({rock, record, first});
    }
  }
  const SharedCorrelations rho = shared_correlations(pairs, thresholds);
  EXPECT_NEAR(rho.rock, 0.16 / 0.29, 0.1);
  EXPECT_NEAR(rho.record, 0.09 / 0.29, 0.15);
  const SharedCorrelations near = near_correlations(pairs, thresholds, {rho.rock + 0.01, rho.record - 0.01});
  EXPECT_NEAR(near.rock, rho.rock, 1e-3);
  EXPECT_NEAR(near.record, rho.record, 1e-3);
}

}  // namespace
}  // namespace keyblock::statistics
