#include "rockmass/random_strength.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace keyblock::rockmass {
namespace {

constexpr TraceSource first_set{TraceSource::Kind::joint_set, 0};

Trace trace_at(std::uint32_t line, std::uint32_t interval, TraceSource source = first_set) {
  return {{}, {1.0, 0.0}, source, 0, line, interval};
}

RandomStrength friction(DistributionKind kind, double mean, double std, double min = 0.0, double max = 89.0) {
  return {{kind, mean, std}, min, max, DrawnPer::joint};
}

double std_normal_density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
}

double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

TEST(RandomStrength, IsCutOffAtBothEnds) {
  for (const DistributionKind kind : {DistributionKind::uniform, DistributionKind::normal,
                                      DistributionKind::lognormal, DistributionKind::exponential}) {
    const RandomStrength random = friction(kind, 30.0, 12.0, 20.0, 45.0);
    double before = 20.0;
    for (int k = 0; k < 1000; ++k) {
      const double x = random.quantile((k + 0.5) / 1000.0);
      EXPECT_GE(x, before);
      before = x;
    }
    EXPECT_LE(before, 45.0);
    EXPECT_NEAR(random.quantile(1e-9), 20.0, 1e-5);
    EXPECT_NEAR(random.quantile(1.0 - 1e-9), 45.0, 1e-5);
  }
}

/// Johnson, Kotz & Balakrishnan 1994, 13.10.1: mean of a normal distribution between a and b.
TEST(RandomStrength, HasTheMeanOfATruncatedNormalDistribution) {
  const double mean = 35.0, std = 8.0, a = (30.0 - mean) / std, b = (50.0 - mean) / std;
  const double expected =
      mean + std * (std_normal_density(a) - std_normal_density(b)) / (normal_cdf(b) - normal_cdf(a));
  EXPECT_NEAR(friction(DistributionKind::normal, mean, std, 30.0, 50.0).truncated_mean(), expected, 1e-5);
}

TEST(RandomStrength, WithoutACutHasMeanAndDeviationAsAsked) {
  for (const DistributionKind kind :
       {DistributionKind::uniform, DistributionKind::normal, DistributionKind::lognormal}) {
    const RandomStrength random{{kind, 40e3, 8e3}, 0.0, HUGE_VAL, DrawnPer::joint};
    double sum = 0.0, squares = 0.0;
    constexpr int n = 20000;
    for (int k = 0; k < n; ++k) {
      const double x = random.quantile((k + 0.5) / n);
      sum += x;
      squares += (x - 40e3) * (x - 40e3);
    }
    EXPECT_NEAR(sum / n, 40e3, 20.0);
    EXPECT_NEAR(std::sqrt(squares / n), 8e3, 20.0);
  }
  EXPECT_EQ(friction(DistributionKind::constant, 33.0, 0.0).quantile(0.7), 33.0);
}

TEST(RandomStrength, DrawsHaveMeanAndDeviationOfTheDistribution) {
  const RandomStrength random = friction(DistributionKind::normal, 35.0, 3.0);
  constexpr int n = 4000;
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < n; ++k) {
    const double x = random.quantile(uniform_of(
        {7, 3, 0}, trace_at(static_cast<std::uint32_t>(k / 40), static_cast<std::uint32_t>(k % 40)),
        StrengthKey::friction, DrawnPer::joint));
    sum += x - 35.0;
    squares += (x - 35.0) * (x - 35.0);
  }
  EXPECT_NEAR(sum / n, 0.0, 3.0 * 3.0 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 3.0, 3.0 * 3.0 / std::sqrt(2.0 * n));
}

TEST(UniformOf, DependsOnWhatItIsKeyedByAndOnNothingElse) {
  const Sampling sampling{5, 2, 0};
  const auto joint = [&](const Trace& trace, StrengthKey key = StrengthKey::friction,
                         const Sampling* other = nullptr) {
    return uniform_of(other != nullptr ? *other : sampling, trace, key, DrawnPer::joint);
  };
  const TraceSource map{TraceSource::Kind::trace_map, 0}, second{TraceSource::Kind::joint_set, 1};
  const Sampling next{5, 3, 0}, seed{6, 2, 0};
  const std::set<double> all{joint(trace_at(1, 2)),
                             joint(trace_at(2, 1)),
                             joint(trace_at(1, 3)),
                             joint(trace_at(1, 2, map)),
                             joint(trace_at(1, 2, second)),
                             joint(trace_at(1, 2), StrengthKey::cohesion),
                             joint(trace_at(1, 2), StrengthKey::friction, &next),
                             joint(trace_at(1, 2), StrengthKey::friction, &seed)};
  EXPECT_EQ(all.size(), 8U);
  EXPECT_EQ(joint(trace_at(1, 2)), joint(trace_at(1, 2)));
  EXPECT_EQ(joint(trace_at(1, 2), StrengthKey::residual_friction), joint(trace_at(1, 2)));
  EXPECT_EQ(joint(trace_at(1, 2), StrengthKey::residual_cohesion),
            joint(trace_at(1, 2), StrengthKey::cohesion));
  const auto drawn = [&](const Trace& trace, DrawnPer per) {
    return uniform_of(sampling, trace, StrengthKey::friction, per);
  };
  EXPECT_EQ(drawn(trace_at(4, 1), DrawnPer::line), drawn(trace_at(4, 9), DrawnPer::line));
  EXPECT_NE(drawn(trace_at(4, 1), DrawnPer::line), drawn(trace_at(5, 1), DrawnPer::line));
  EXPECT_EQ(drawn(trace_at(4, 1), DrawnPer::realization), drawn(trace_at(5, 2), DrawnPer::realization));
}

TEST(UniformOf, OfALatinHypercubeIsOnceInEachInterval) {
  constexpr int n = 50;
  for (const StrengthKey key : {StrengthKey::friction, StrengthKey::cohesion}) {
    std::vector<int> intervals;
    for (int realization = 0; realization < n; ++realization) {
      const double u = uniform_of({3, realization, n}, trace_at(1, 1), key, DrawnPer::realization);
      intervals.push_back(static_cast<int>(u * n));
    }
    EXPECT_FALSE(std::ranges::is_sorted(intervals));
    std::ranges::sort(intervals);
    for (int k = 0; k < n; ++k) EXPECT_EQ(intervals[static_cast<std::size_t>(k)], k);
  }
  const auto beyond = [](int strata) {
    return uniform_of({3, n, strata}, trace_at(1, 1), StrengthKey::friction, DrawnPer::realization);
  };
  EXPECT_EQ(beyond(n), beyond(0)) << "realizations beyond them are independent";
}

}  // namespace
}  // namespace keyblock::rockmass
