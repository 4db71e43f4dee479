#include "statistics/rate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyblock::statistics {
namespace {

/// n points, evenly spaced in the logarithm.
template <class Of>
HazardCurve hazard_of(double first, double last, int n, const Of& of) {
  HazardCurve hazard;
  for (int i = 0; i < n; ++i) {
    const double x = first * std::pow(last / first, static_cast<double>(i) / (n - 1));
    hazard.intensity.push_back(x);
    hazard.rate.push_back(of(x));
  }
  return hazard;
}

double power_law(double x) {
  return 0.01 * std::pow(x, -2.5);
}
double bent(double x) {
  return 0.01 * std::exp(-1.6 * std::log(x) - 0.35 * std::log(x) * std::log(x));
}

void expect_share(double value, double expected, double tolerance) {
  EXPECT_NEAR(value / expected, 1.0, tolerance);
}

constexpr double closed_form = 6.825627533798806e-4;  // k₀ θ^−k e^{k²β²/2}

TEST(AnnualRate, IsExactForAPowerLaw) {
  for (const int n : {6, 61}) {
    const Rate rate = annual_rate(hazard_of(1e-3, 1e5, n, power_law), {4.0, 0.5});
    expect_share(rate.inside, closed_form, 1e-10);
  }
}

TEST(AnnualRate, NamesWhatLiesBeyondTheEnds) {
  HazardCurve hazard = hazard_of(0.5, 20.0, 12, power_law);
  const Rate rate = annual_rate(hazard, {4.0, 0.5});
  expect_share(rate.inside, 6.766401450074271e-4, 1e-9);
  expect_share(rate.beyond_low, 5.586572831433408e-6, 1e-9);
  expect_share(rate.beyond_high, 5.590169943749474e-6, 1e-9);
  expect_share(rate.below, 3.333519855066884e-7, 1e-9);
  hazard.end = 20.0;
  EXPECT_EQ(annual_rate(hazard, {4.0, 0.5}).beyond_high, rate.beyond_low);
}

TEST(AnnualRate, DisaggregatesByIntensity) {
  const HazardCurve hazard = hazard_of(1e-3, 1e5, 61, power_law);
  const Lognormal fragility{4.0, 0.5};
  const double at[] = {1.727533762545266, 3.0708887413226225, 5.84374020708915};
  const double share[] = {0.16, 0.5, 0.84};
  for (int i = 0; i < 3; ++i) {
    const auto up_to = [&](double x) { return rate_up_to(hazard, fragility, x); };
    expect_share(intensity_where(up_to, share[i] * closed_form, 1e-3, 1e5), at[i], 1e-6);
    expect_share(rate_up_to(hazard, fragility, at[i]), share[i] * closed_form, 1e-6);
  }
}

// Vamvatsikos (2013): √p k₀^{1−p} λ(θ)^p e^{k₁²pβ²/2}, p = 1/(1 + 2 k₂ β²), is 1.034705462e-3.
TEST(AnnualRate, ComesToThatOfABentHazard) {
  const Lognormal fragility{4.0, 0.5};
  const std::pair<int, double> cases[] = {{10, 1.0107603500274316e-3},
                                          {20, 1.0292427215822704e-3},
                                          {40, 1.0333749727953713e-3},
                                          {200, 1.0346154347042466e-3}};
  for (const auto& [n, expected] : cases)
    expect_share(annual_rate(hazard_of(0.2, 60.0, n, bent), fragility).inside, expected, 1e-8);
}

TEST(AnnualRate, OfAStepIsTheHazardThere) {
  const HazardCurve hazard = hazard_of(0.1, 50.0, 20, bent);
  const Rate rate = annual_rate(hazard, {4.0, 1e-6});
  expect_share(rate.inside, 5.511212117849628e-4, 1e-5);
  expect_share(rate.inside + rate.beyond_low, hazard.rate_at(4.0), 1e-5);
}

// At kβ = 1: the part of the rate from where P is below p.
TEST(AnnualRate, HangsLittleOnTheFarTailOfTheCurve) {
  const HazardCurve hazard = hazard_of(1e-4, 1e4, 9, [](double x) { return 1e-3 * std::pow(x, -2.0); });
  const Lognormal fragility{1.0, 0.5};
  const std::pair<double, double> cases[] = {{-3.090232306167813, 0.0049656},
                                             {-2.3263478740408408, 0.0302506}};
  for (const auto& [z, share] : cases)
    EXPECT_NEAR(rate_up_to(hazard, fragility, std::exp(0.5 * z)) / annual_rate(hazard, fragility).total(),
                share, 1e-6);
}

const Scatter scatter{0.4, 0.25, 0.1658312395177700};

TEST(Lifetime, IsLessLikelyThanTheMeanRateSays) {
  const Lifetime life = over_lifetime(hazard_of(1e-3, 1e5, 61, power_law), 4.0, scatter, 100.0);
  expect_share(life.poisson, 0.06597892366430658, 1e-5);
  expect_share(life.probability, 0.06275357613116926, 1e-5);
  expect_share(life.p05, 7.99179786797059e-05, 1e-5);
  expect_share(life.p50, 4.1399523721e-4, 1e-5);
  expect_share(life.p95, 2.144599490318463e-3, 1e-5);
}

TEST(Sections, FailTogetherUnderTheSameEarthquakes) {
  const HazardCurve hazard = hazard_of(0.02, 2000.0, 6, power_law);
  expect_share(rate_of_sections(hazard, 4.0, scatter, 1.0), 6.825627e-4, 1e-5);
  expect_share(rate_of_sections(hazard, 4.0, scatter, 10.0), 2.508459182352256e-3, 1e-5);
  expect_share(rate_of_sections(hazard, 4.0, scatter, 100.0), 6.471725514799313e-3, 1e-5);
}

TEST(PointsRate, IsThatOfTheMeansOfAMeasure) {
  const KnownPoints points{{2.0, 4.0, 8.0}, {0.1, 0.8, 2.0}};
  for (const int n : {3, 40}) {
    const PointsRate rate = rate_of_points(hazard_of(0.5, 50.0, n, power_law), points);
    expect_share(rate.between, 8.323020841621723e-4, 1e-8);
    expect_share(rate.beyond_low, 1.1048543456039807e-4, 1e-8);
    expect_share(rate.below, 8.838834764831845e-4, 1e-8);
  }
}

// The measure falls slower than shaking gets more frequent: what weak shaking adds has no end.
TEST(PointsRate, HasNoEndBelowWhereTheHazardIsSteeper) {
  const KnownPoints points{{2.0, 4.0}, {0.4, 0.8}};
  EXPECT_TRUE(std::isnan(rate_of_points(hazard_of(0.5, 50.0, 9, power_law), points).below));
  EXPECT_EQ(rate_of_points(hazard_of(0.5, 50.0, 9, power_law), {{2.0, 4.0}, {0.0, 0.8}}).below, 0.0);
}

}  // namespace
}  // namespace keyblock::statistics
