#include "rockmass/trace_generator.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>

#include "core/error.h"
#include "rockmass/distribution.h"
#include "rockmass/section.h"
#include "statistics.h"
#include "verification/reference_distribution.h"

namespace keyblock::rockmass {
namespace {

using verification::kolmogorov_smirnov;
using enum DistributionKind;

constexpr double azimuth = 165.0;
constexpr int realizations = 60;
const Box window{{-10.0, -10.0}, {10.0, 10.0}};

JointSet joint_set(double dip, double direction, Distribution spacing, Distribution length,
                   Distribution gap) {
  JointSet set;
  set.name = "J";
  set.dip = dip;
  set.dip_direction = direction;
  set.spacing = spacing;
  set.length = length;
  set.gap = gap;
  return set;
}

/// The part of a trace in the window, m.
double length_inside(const Trace& trace) {
  double from = 0.0, to = 1.0;
  const Vec2 d = trace.b - trace.a;
  const auto bound = [&](double p, double q) {  // s p ≤ q
    if (p > 0.0) to = std::min(to, q / p);
    if (p < 0.0) from = std::max(from, q / p);
  };
  bound(d.x, window.max.x - trace.a.x);
  bound(-d.x, trace.a.x - window.min.x);
  bound(d.y, window.max.y - trace.a.y);
  bound(-d.y, trace.a.y - window.min.y);
  return std::max(0.0, to - from) * norm(d);
}

/// Whether the trace crosses the horizontal line through height y within the window.
bool crosses_scanline(const Trace& trace, double y) {
  if ((trace.a.y > y) == (trace.b.y > y)) return false;
  const Vec2 p = lerp(trace.a, trace.b, (y - trace.a.y) / (trace.b.y - trace.a.y));
  return std::abs(p.x) < 10.0;
}

class EverySet : public testing::TestWithParam<JointSet> {
 protected:
  static std::vector<Trace> traces(int realization) {
    return generate_traces(GetParam(), 0, azimuth, window, 2001, realization);
  }
  static double spacing_in_section() {
    return truncated_mean(GetParam().spacing) *
           trace_spacing_factor(GetParam().dip, GetParam().dip_direction, azimuth);
  }
};

TEST_P(EverySet, IntensitiesAreThoseOfTheStatistics) {
  const JointSet& set = GetParam();
  const double spacing = spacing_in_section(), length = truncated_mean(set.length),
               gap = truncated_mean(set.gap);
  std::vector<double> p21, p20, p10;
  for (int realization = 0; realization < realizations; ++realization) {
    double inside = 0.0;
    int centres = 0, crossings = 0;
    for (const Trace& trace : traces(realization)) {
      inside += length_inside(trace);
      centres += window.contains(0.5 * (trace.a + trace.b));
      for (const double y : {-8.0, -4.0, 0.0, 4.0, 8.0}) crossings += crosses_scanline(trace, y);
    }
    p21.push_back(inside / 400.0);
    p20.push_back(centres / 400.0);
    p10.push_back(crossings / 100.0);
  }
  const double expected_p21 = length / (spacing * (length + gap));
  const double sine = std::abs(std::sin(radians(apparent_dip(set.dip, set.dip_direction, azimuth))));
  EXPECT_NEAR(Estimate(p21).mean, expected_p21, 3.0 * Estimate(p21).error);
  EXPECT_NEAR(Estimate(p20).mean, 1.0 / (spacing * (length + gap)), 3.0 * Estimate(p20).error);
  EXPECT_NEAR(Estimate(p10).mean, expected_p21 * sine, 3.0 * Estimate(p10).error);
  // The test is worth something only if the estimates are sharp.
  EXPECT_LT(Estimate(p21).error, 0.05 * expected_p21);
}

INSTANTIATE_TEST_SUITE_P(
    Sets, EverySet,
    testing::Values(joint_set(79, 270, {uniform, 0.3, 0.105}, {uniform, 1.8, 0.63}, {uniform, 0.4, 0.14}),
                    joint_set(81, 230, {uniform, 0.3, 0.105}, {uniform, 2.4, 0.84}, {uniform, 0.3, 0.105}),
                    joint_set(5, 165, {uniform, 0.5, 0.175}, {uniform, 1.8, 0.63}, {uniform, 0.5, 0.175}),
                    joint_set(40, 120, {exponential, 0.3, 0.0}, {lognormal, 1.0, 0.7},
                              {exponential, 0.5, 0.0}),
                    joint_set(60, 350, {lognormal, 0.4, 0.3}, {normal, 1.5, 0.5}, {normal, 0.5, 0.4})));

const JointSet plain = joint_set(60, 165, {uniform, 0.3, 0.105}, {uniform, 1.8, 0.63}, {uniform, 0.4, 0.14});

bool before(const Trace& s, const Trace& t) {
  return std::tie(s.a.x, s.a.y, s.b.x, s.b.y) < std::tie(t.a.x, t.a.y, t.b.x, t.b.y);
}

TEST(TraceGenerator, ConstantSpacingHasARandomPhase) {
  JointSet set = plain;
  set.dip = 0.0;
  set.spacing = {constant, 1.0, 0.0};
  std::vector<double> phases;
  for (int realization = 0; realization < 400; ++realization) {
    const double y = generate_traces(set, 0, azimuth, window, 7, realization).front().a.y;
    phases.push_back(y - std::floor(y));
  }
  EXPECT_LT(kolmogorov_smirnov(phases, {uniform, 0.5, 1.0 / std::sqrt(12.0)}), 1.63);
}

TEST(TraceGenerator, AGrownWindowKeepsItsTraces) {
  JointSet set = plain;
  for (const double scatter : {0.0, 8.0}) {
    set.dip_std = scatter;
    std::vector<Trace> small = generate_traces(set, 1, azimuth, window, 5, 3);
    std::vector<Trace> large = generate_traces(set, 1, azimuth, window.grown(7.0), 5, 3);
    EXPECT_GT(large.size(), small.size());
    std::sort(small.begin(), small.end(), before);
    std::sort(large.begin(), large.end(), before);
    EXPECT_TRUE(std::includes(large.begin(), large.end(), small.begin(), small.end(), before));
  }
}

// Together with them the traces fill their lines, turned or not.
TEST(TraceGenerator, GapsBeginAndEndAtTraces) {
  JointSet set = plain;
  for (const double scatter : {0.0, 8.0}) {
    set.dip_std = scatter;
    const std::vector<Trace> traces = generate_traces(set, 1, azimuth, window.grown(30.0), 5, 3),
                             gaps = gaps_of_traces(set, 1, azimuth, window, 5, 3);
    EXPECT_GT(gaps.size(), 20U);
    for (const Trace& gap : gaps) {
      const auto is_at = [&](Vec2 p, Vec2 Trace::*end) {
        return std::ranges::any_of(traces, [&](const Trace& trace) { return trace.*end == p; });
      };
      EXPECT_TRUE(is_at(gap.a, &Trace::b));
      EXPECT_TRUE(is_at(gap.b, &Trace::a));
    }
  }
}

TEST(TraceGenerator, RealizationsAndSetsDiffer) {
  const auto first = [](std::uint64_t seed, int realization, int set) {
    return generate_traces(plain, set, azimuth, window, seed, realization).front().a;
  };
  EXPECT_EQ(first(1, 0, 0), first(1, 0, 0));
  EXPECT_NE(first(1, 0, 0), first(2, 0, 0));
  EXPECT_NE(first(1, 0, 0), first(1, 1, 0));
  EXPECT_NE(first(1, 0, 0), first(1, 0, 1));
}

TEST(TraceGenerator, TheSameBitsEverywhere) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3; };
  JointSet set = plain;
  set.dip_direction_std = 5.0;
  set.length = {lognormal, 1.8, 0.6};
  for (const Trace& trace : generate_traces(set, 2, azimuth, window, 2001, 17)) {
    for (const double x : {trace.a.x, trace.a.y, trace.b.x, trace.b.y}) {
      EXPECT_EQ(x, std::nearbyint(x * 0x1p30) * 0x1p-30);
      add(x);
    }
    EXPECT_EQ(trace.source, (TraceSource{TraceSource::Kind::joint_set, 2}));
  }
  EXPECT_EQ(hash, 17807444675074929493u);
}

TEST(TraceGenerator, OrientationScattersAboutItsMean) {
  JointSet set = plain;
  set.dip_std = 4.0;
  std::vector<double> dips, squares;
  std::vector<double> lengths;
  for (int realization = 0; realization < 10; ++realization) {
    for (const Trace& trace : generate_traces(set, 0, azimuth, window, 11, realization)) {
      const Vec2 middle = 0.5 * (trace.a + trace.b), d = trace.b - trace.a;
      if (!window.grown(-2.0).contains(middle)) continue;
      const double dip = std::atan(-d.y / d.x) / radians(1.0);
      dips.push_back(dip);
      squares.push_back((dip - 60.0) * (dip - 60.0));
      lengths.push_back(norm(d));
    }
  }
  EXPECT_NEAR(Estimate(dips).mean, 60.0, 3.0 * Estimate(dips).error);
  EXPECT_NEAR(Estimate(squares).mean, 16.0, 3.0 * Estimate(squares).error);
  EXPECT_LT(kolmogorov_smirnov(lengths, set.length), 1.63);
}

TEST(TraceGenerator, SpacingMeasuredInTheSection) {
  JointSet set = joint_set(79, 270, {uniform, 0.5, 0.2}, {constant, 1.0, 0.0}, {constant, 0.0, 0.0});
  set.spacing_measure = SpacingMeasure::trace_spacing;
  std::vector<double> p21;
  for (int realization = 0; realization < 40; ++realization) {
    double inside = 0.0;
    for (const Trace& trace : generate_traces(set, 0, azimuth, window, 3, realization))
      inside += length_inside(trace);
    p21.push_back(inside / 400.0);
  }
  EXPECT_NEAR(Estimate(p21).mean, 2.0, 3.0 * Estimate(p21).error);
}

TEST(TraceGenerator, AnAbsurdNumberIsRefusedWithTheEstimate) {
  JointSet set = plain;
  set.spacing = {constant, 1e-5, 0.0};
  try {
    generate_traces(set, 0, azimuth, window, 1, 0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().at(0).key, "joint_set.'J'");
    EXPECT_EQ(error.diagnostics().at(0).found, "statistics that give about 3.6e+07 traces in the domain");
  }
}

TEST(TraceGenerator, TheEstimateIsRight) {
  double count = 0.0;
  for (int realization = 0; realization < 20; ++realization) {
    count += static_cast<double>(generate_traces(plain, 0, azimuth, window, 1, realization).size()) / 20.0;
  }
  // An estimate for the box around the window as seen along the lines: too large, but not by much.
  EXPECT_GT(expected_traces(plain, azimuth, window), count);
  EXPECT_LT(expected_traces(plain, azimuth, window), 2.0 * count);
}

TEST(TraceGenerator, PlanesParallelToTheSectionAreNotSeen) {
  JointSet set = plain;
  set.dip = 90.0;
  set.dip_direction = azimuth + 90.0;
  EXPECT_TRUE(generate_traces(set, 0, azimuth, window, 1, 0).empty());
}

}  // namespace
}  // namespace keyblock::rockmass
