#include "statistics/fragility.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random.h"

namespace keyblock::statistics {
namespace {

/// Brute force: the likelihood on a grid that is drawn in around its best point, sharing nothing with the fit.
std::pair<double, double> grid_search(const std::vector<Stripe>& stripes) {
  double log_theta = 0.0, log_beta = 0.0;
  for (double reach = 4.0; reach > 1e-9; reach *= 0.6) {
    double best = -std::numeric_limits<double>::infinity(), best_theta = 0.0, best_beta = 0.0;
    for (int i = -20; i <= 20; ++i) {
      for (int j = -20; j <= 20; ++j) {
        const double t = log_theta + reach * i / 20.0, b = log_beta + reach * j / 20.0;
        double sum = 0.0;
        for (const Stripe& s : stripes) {
          const double z = (std::log(s.intensity) - t) / std::exp(b) / std::sqrt(2.0);
          const double p = 0.5 * std::erfc(-z), q = 0.5 * std::erfc(z);
          sum += (s.exceeded > 0.0 ? s.exceeded * std::log(p) : 0.0) +
                 (s.exceeded < s.runs ? (s.runs - s.exceeded) * std::log(q) : 0.0);
        }
        if (sum > best) {
          best = sum;
          best_theta = t;
          best_beta = b;
        }
      }
    }
    log_theta = best_theta;
    log_beta = best_beta;
  }
  return {std::exp(log_theta), std::exp(log_beta)};
}

/// Realizations with lognormal capacities, each shaken at every intensity; `scatter` is of the single run.
std::vector<Observation> made_up(std::uint64_t seed, int realizations, const std::vector<double>& intensities,
                                 double theta, double beta, double scatter) {
  std::vector<Observation> runs;
  for (int r = 0; r < realizations; ++r) {
    const RandomStream stream(seed, static_cast<std::uint32_t>(r), 0, 0);
    const double common = std::sqrt(beta * beta - scatter * scatter) * inverse_normal_cdf(stream.uniform(0));
    for (std::size_t k = 0; k < intensities.size(); ++k) {
      const double own = scatter * inverse_normal_cdf(stream.uniform(static_cast<std::uint32_t>(k + 1)));
      runs.push_back({intensities[k], intensities[k] > theta * std::exp(common + own), r});
    }
  }
  return runs;
}

const std::vector<double> scales{0.5, 0.8, 1.2, 2.0, 3.0};

// Multiple stripes as in Baker (2015): eight intensities, 40 motions at each.
TEST(Fragility, FindsWhatAGridSearchFinds) {
  const std::vector<std::vector<Stripe>> cases{{{0.2, 40, 0},
                                                {0.3, 40, 0},
                                                {0.4, 40, 0},
                                                {0.6, 40, 4},
                                                {0.7, 40, 6},
                                                {0.8, 40, 13},
                                                {0.9, 40, 12},
                                                {1.0, 40, 16}},
                                               {{1.0, 10, 1}, {2.0, 20, 8}, {4.0, 5, 4}},
                                               {{0.1, 30, 29}, {0.2, 30, 30}, {0.01, 30, 12}, {0.02, 30, 15}},
                                               {{1.0, 7, 3}, {1.1, 7, 4}},
                                               {{1e-3, 50, 1}, {2e-3, 50, 49}}};
  for (const auto& stripes : cases) {
    const FragilityFit fit = fit_fragility(stripes);
    ASSERT_EQ(fit.status, FragilityStatus::fitted);
    const auto [theta, beta] = grid_search(stripes);
    EXPECT_NEAR(fit.theta / theta, 1.0, 1e-5);
    EXPECT_NEAR(fit.beta / beta, 1.0, 1e-5);
  }
}

// Two stripes: the curve goes through both points, 20 % at 1 and 80 % at 4.
TEST(Fragility, PassesThroughTwoPoints) {
  const std::vector<Stripe> stripes{{1.0, 10, 2}, {4.0, 10, 8}};
  const FragilityFit fit = fit_fragility(stripes);
  EXPECT_NEAR(fit.theta, 2.0, 1e-9);
  EXPECT_NEAR(fit.beta, std::log(4.0) / (2.0 * inverse_normal_cdf(0.8)), 1e-9);
  EXPECT_NEAR(fit.probability(1.0), 0.2, 1e-9);
  EXPECT_NEAR(fit.probability(4.0), 0.8, 1e-9);
  EXPECT_EQ(fit.probability(0.0), 0.0);
}

TEST(Fragility, UnitsOfIntensityDoNotMatter) {
  std::vector<Stripe> stripes{{0.5, 30, 3}, {1.0, 30, 9}, {2.0, 30, 21}};
  const FragilityFit fit = fit_fragility(stripes);
  for (Stripe& s : stripes) s.intensity *= 9.81e6;
  const FragilityFit scaled = fit_fragility(stripes);
  EXPECT_NEAR(scaled.theta / fit.theta, 9.81e6, 1e-2);
  EXPECT_NEAR(scaled.beta, fit.beta, 1e-9);
}

TEST(Fragility, RecoversWhatDataWereMadeFrom) {
  const std::vector<Observation> runs = made_up(5, 2000, scales, 1.5, 0.5, 0.5);
  const FragilityCurve curve = fragility_curve(runs, scales, 0.95, {}, 200);
  EXPECT_NEAR(curve.theta.value, 1.5, 0.05);
  EXPECT_NEAR(curve.beta.value, 0.5, 0.05);
  EXPECT_LT(curve.theta.low, curve.theta.value);
  EXPECT_GT(curve.theta.high, curve.theta.value);
  EXPECT_EQ(curve.clusters, 2000U);
  EXPECT_EQ(curve.resamples_fitted, 200U);
  for (std::size_t k = 0; k < scales.size(); ++k) {
    EXPECT_LT(curve.probability[k].low, curve.probability[k].value);
    EXPECT_GT(curve.probability[k].high, curve.probability[k].value);
    EXPECT_EQ(curve.stripes[k].runs, 2000.0);
  }
}

// What the runs of a realization have in common widens the band; the interval still covers.
TEST(Fragility, BootstrapOverRealizationsCovers) {
  const double theta = 1.3, beta = 0.6;
  const int trials = 100;
  int covered = 0;
  double width = 0.0, naive_width = 0.0;
  for (int t = 0; t < trials; ++t) {
    std::vector<Observation> runs =
        made_up(static_cast<std::uint64_t>(100 + t), 50, scales, theta, beta, 0.15);
    const FragilityCurve curve = fragility_curve(runs, {}, 0.9, {}, 150);
    covered += curve.theta.low <= theta && theta <= curve.theta.high ? 1 : 0;
    width += curve.theta.high - curve.theta.low;
    int cluster = 0;
    for (Observation& run : runs) run.cluster = cluster++;
    const FragilityCurve naive = fragility_curve(runs, {}, 0.9, {}, 150);
    naive_width += naive.theta.high - naive.theta.low;
  }
  EXPECT_GT(covered, 0.82 * trials);
  EXPECT_LT(covered, 0.98 * trials);
  EXPECT_GT(width, 1.2 * naive_width);
}

TEST(Fragility, SaysWhyThereIsNoCurve) {
  using Stripes = std::vector<Stripe>;
  const auto status = [](const Stripes& stripes) { return fit_fragility(stripes).status; };
  EXPECT_EQ(status({}), FragilityStatus::no_data);
  EXPECT_EQ(status({{1, 0, 0}}), FragilityStatus::no_data);
  EXPECT_EQ(status({{1, 10, 5}}), FragilityStatus::one_intensity);
  EXPECT_EQ(status({{1, 10, 0}, {2, 10, 0}}), FragilityStatus::never_exceeded);
  EXPECT_EQ(status({{1, 10, 10}, {2, 10, 10}}), FragilityStatus::always_exceeded);
  EXPECT_EQ(status({{1, 10, 0}, {2, 10, 10}}), FragilityStatus::separated);
  EXPECT_EQ(status({{1, 10, 0}, {2, 10, 4}, {3, 10, 10}}), FragilityStatus::separated);
  EXPECT_EQ(status({{1, 10, 0}, {2, 10, 4}}), FragilityStatus::separated);
  EXPECT_EQ(status({{1, 3, 2}, {2, 3, 3}}), FragilityStatus::separated);
  EXPECT_EQ(status({{1, 10, 5}, {2, 10, 5}}), FragilityStatus::not_increasing);
  EXPECT_EQ(status({{1, 10, 8}, {2, 10, 3}}), FragilityStatus::not_increasing);
  EXPECT_EQ(status({{1, 10, 10}, {2, 10, 0}}), FragilityStatus::not_increasing);
  EXPECT_EQ(status({{1, 10, 10}, {2, 10, 4}, {3, 10, 0}}), FragilityStatus::not_increasing);
  EXPECT_EQ(status({{1, 10, 1}, {2, 10, 4}}), FragilityStatus::fitted);

  const FragilityFit parted = fit_fragility(Stripes{{1, 10, 0}, {4, 10, 10}});
  EXPECT_DOUBLE_EQ(parted.theta, 2.0);
  EXPECT_EQ(parted.beta, 0.0);
  EXPECT_EQ(parted.probability(1.9), 0.0);
  EXPECT_EQ(parted.probability(2.1), 1.0);
  EXPECT_EQ(fit_fragility(Stripes{{1, 10, 8}, {2, 10, 3}}).probability(7.0), 0.55);
}

/// Realizations that exceed the level at so many of the strongest intensities: counts[k] of them at k of these.
std::vector<Observation> exceeding(const std::vector<int>& counts, const std::vector<double>& intensities) {
  std::vector<Observation> runs;
  int realization = 0;
  for (std::size_t often = 0; often < counts.size(); ++often) {
    for (int k = 0; k < counts[often]; ++k, ++realization) {
      for (std::size_t i = 0; i < intensities.size(); ++i)
        runs.push_back({intensities[i], i + often >= intensities.size(), realization});
    }
  }
  return runs;
}

const std::vector<double> three{3.5, 6.9, 10.3};

FragilityCurve curve_of(const std::vector<Observation>& runs) {
  return fragility_curve(runs, three, 0.95);
}

void expect_no_curve(const FragilityCurve& curve, FragilityStatus why) {
  EXPECT_EQ(curve.status, why);
  EXPECT_TRUE(curve.intensity.empty());
  EXPECT_TRUE(curve.probability.empty());
  EXPECT_EQ(curve.stripes.size(), 3U);  // the points are there
}

TEST(Fragility, NothingIsDrawnWhereThereIsNoFit) {
  const FragilityCurve never = curve_of(exceeding({20}, three));
  expect_no_curve(never, FragilityStatus::never_exceeded);
  EXPECT_TRUE(std::isnan(never.theta.value));
  EXPECT_TRUE(std::isnan(never.theta.low));
  const FragilityCurve always = curve_of(exceeding({0, 0, 0, 20}, three));
  expect_no_curve(always, FragilityStatus::always_exceeded);
  EXPECT_TRUE(std::isnan(always.theta.value));
  EXPECT_EQ(fragility_curve({}, three, 0.95).status, FragilityStatus::no_data);
}

// One failure in sixty runs: no step to 1, no median.
TEST(Fragility, OneFailureIsNoCurve) {
  const FragilityCurve curve = curve_of(exceeding({19, 1}, three));
  expect_no_curve(curve, FragilityStatus::separated);
  EXPECT_TRUE(std::isnan(curve.theta.value));
  EXPECT_TRUE(std::isnan(curve.beta.value));
  EXPECT_EQ(curve.stripes[2].exceeded, 1.0);
}

// Nine of twenty fall by gravity at any shaking, three more by the shaking: θ and β could be anything.
TEST(Fragility, AnIntervalThatSpansTooMuchIsNoCurve) {
  const FragilityCurve gravity = curve_of(exceeding({8, 2, 1, 9}, three));
  EXPECT_EQ(gravity.fit.status, FragilityStatus::fitted);
  expect_no_curve(gravity, FragilityStatus::wide_theta);
  EXPECT_GT(gravity.theta.high, 4.0 * gravity.theta.low);
  const FragilityCurve shaking = curve_of(exceeding({10, 6, 4}, three));
  EXPECT_LE(shaking.theta.high, 4.0 * shaking.theta.low);
  // With more realizations of the same rock it is a curve.
  const std::vector<Observation> runs = exceeding({100, 60, 30, 10}, three);
  const FragilityCurve many = curve_of(runs);
  EXPECT_EQ(many.status, FragilityStatus::fitted);
  EXPECT_EQ(many.probability.size(), 3U);
  FragilityLimits strict;
  strict.widest_theta = (1.0 - 1e-9) * many.theta.high / many.theta.low;
  EXPECT_EQ(fragility_curve(runs, three, 0.95, strict).status, FragilityStatus::wide_theta);
  strict.widest_theta *= 1.0 + 1e-6;
  EXPECT_EQ(fragility_curve(runs, three, 0.95, strict).status, FragilityStatus::fitted);
  strict.widest_beta = (1.0 - 1e-9) * many.beta.high / many.beta.low;
  EXPECT_EQ(fragility_curve(runs, three, 0.95, strict).status, FragilityStatus::wide_beta);
}

// A realization is in no resample of 20 with a probability of (1 − 1/20)^20 = 36 %, neither of two with 12 %.
TEST(Fragility, AFitThatHangsOnASingleRealizationIsNoCurve) {
  const FragilityCurve one = curve_of(exceeding({17, 2, 1}, three));
  EXPECT_EQ(one.fit.status, FragilityStatus::fitted);
  EXPECT_NEAR(static_cast<double>(one.resamples_fitted) / 1000.0, 0.62, 0.05);
  expect_no_curve(one, FragilityStatus::few_fits);
  const FragilityCurve two = curve_of(exceeding({1, 9, 9, 1}, three));
  EXPECT_NEAR(static_cast<double>(two.resamples_fitted) / 1000.0, 0.88, 0.03);
  EXPECT_EQ(two.status, FragilityStatus::fitted);
}

// Resamples whose shares do not increase have a β without end; they are not left out of its interval.
TEST(Fragility, ResamplesThatDoNotIncreaseWidenTheIntervals) {
  const FragilityCurve flat = curve_of(exceeding({10, 1, 1, 8}, three));
  EXPECT_EQ(flat.fit.status, FragilityStatus::fitted);
  EXPECT_LT(flat.resamples_fitted, 1000U);
  EXPECT_TRUE(std::isinf(flat.beta.high));
}

TEST(Fragility, FewerRealizationsThanABootstrapNeedsAreNoCurve) {
  expect_no_curve(curve_of(exceeding({1, 1, 1, 1}, three)), FragilityStatus::too_few_clusters);
}

// P(0) = 0: what falls without shaking is not on such a curve.
TEST(Fragility, AShareWithoutShakingIsNoCurve) {
  const auto with_rest = [](int exceeded, int n) {
    std::vector<Observation> runs = exceeding({100, 60, 30, 10}, three);
    for (int k = 0; k < n; ++k) runs.push_back({0.0, k < exceeded, k});
    return curve_of(runs);
  };
  EXPECT_EQ(with_rest(0, 20).status, FragilityStatus::fitted);
  EXPECT_EQ(with_rest(1, 20).status, FragilityStatus::fitted);
  expect_no_curve(with_rest(2, 20), FragilityStatus::exceeded_at_rest);
  EXPECT_EQ(with_rest(2, 20).at_rest.exceeded, 2.0);
  EXPECT_EQ(with_rest(2, 20).at_rest.runs, 20.0);
}

TEST(Fragility, StripesKnowTheirClusters) {
  const std::vector<Observation> runs{{1.0, false, 1}, {2.0, true, 2}, {1.0, true, 2}, {1.0, true, 1}};
  const FragilityCurve curve = fragility_curve(runs, {}, 0.95);
  ASSERT_EQ(curve.stripes.size(), 2U);
  EXPECT_EQ(curve.stripes[0].runs, 3.0);
  EXPECT_EQ(curve.stripes[0].clusters, 2.0);
  EXPECT_EQ(curve.stripes[1].clusters, 1.0);
}

TEST(Fragility, RunsWithoutShakingAreLeftOutAndCounted) {
  std::vector<Observation> runs = made_up(9, 30, scales, 1.3, 0.6, 0.6);
  const FragilityCurve without = fragility_curve(runs, {}, 0.95, {}, 50);
  runs.push_back({0.0, false, 3});
  runs.push_back({0.0, false, 3});
  const FragilityCurve with = fragility_curve(runs, {}, 0.95, {}, 50);
  EXPECT_EQ(with.at_rest.runs, 2.0);
  EXPECT_EQ(with.at_rest.clusters, 1.0);
  EXPECT_EQ(with.theta.value, without.theta.value);
  EXPECT_EQ(with.theta.low, without.theta.low);
}

}  // namespace
}  // namespace keyblock::statistics
