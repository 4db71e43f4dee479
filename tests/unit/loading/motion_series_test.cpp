#include "loading/motion_series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "loading/motion_measures.h"

namespace keyblock::loading {
namespace {

using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

MotionComponent record_of(double dt, std::vector<double> samples) {
  MotionComponent c;
  c.file = "made.csv";
  c.dt = dt;
  c.file_unit = "m/s2";
  c.acceleration = std::move(samples);
  return c;
}

MotionComponent steady_sine(double period, double seconds, double dt) {
  std::vector<double> samples;
  for (int k = 0; k <= std::lround(seconds / dt); ++k)
    samples.push_back(std::sin(2.0 * pi * k * dt / period));
  return record_of(dt, samples);
}

TEST(MotionSeries, VelocityDisplacementAndAriasOfASine) {
  MotionComponent c = steady_sine(2.0, 10.0, 0.001);
  c.start = 3.0;
  const MotionSeries s = motion_series(c, Baseline::none);
  EXPECT_EQ(s.time.front(), 3.0);
  EXPECT_NEAR(s.time.back(), 13.0, 1e-12);
  EXPECT_NEAR(s.velocity[1000], 2.0 / pi, 1e-6);        // (1 − cos ωt)/ω at half a period
  EXPECT_NEAR(s.displacement.back(), 10.0 / pi, 1e-5);  // t/ω after whole periods
  EXPECT_NEAR(s.arias.back(), pi / (2.0 * standard_gravity) * 5.0, 1e-5);
}

TEST(MotionSeries, BaselinesEndWhereTheyPromise) {
  std::vector<double> samples;
  for (int k = 0; k <= 1000; ++k) samples.push_back(std::sin(0.05 * k) + 0.3);
  const MotionComponent c = record_of(0.01, samples);
  EXPECT_GT(std::abs(motion_series(c, Baseline::none).velocity.back()), 1.0);
  EXPECT_NEAR(motion_series(c, Baseline::demean).velocity.back(), 0.0, 1e-12);
  const MotionSeries linear = motion_series(c, Baseline::linear);
  EXPECT_NEAR(linear.velocity.back(), 0.0, 1e-12);
  EXPECT_NEAR(linear.displacement.back(), 0.0, 1e-11);
  const MotionSeries taper = motion_series(c, Baseline::taper);
  EXPECT_EQ(taper.acceleration.front(), 0.0);
  EXPECT_EQ(taper.acceleration.back(), 0.0);
}

// In resonance the response to a steady sine grows to 1/(2ζ) times the acceleration; far above it is the acceleration itself.
TEST(ResponseSpectrum, OfASteadySine) {
  const MotionSeries s = motion_series(steady_sine(0.5, 30.0, 0.005), Baseline::none);
  const auto spectrum = response_spectrum(s, {0.02, 0.5, 50.0}, 0.05);
  EXPECT_NEAR(spectrum[0], 1.0, 0.01);
  EXPECT_NEAR(spectrum[1], 10.0, 0.02);
  EXPECT_LT(spectrum[2], 0.1);
}

// A step of acceleration: the oscillator overshoots by 1 + exp(−πζ/√(1−ζ²)), which lies between the coarse samples. Looked for at forty
// places in a period it is found to within (π/40)²/2, 0.31 %.
TEST(ResponseSpectrum, OfAStepBetweenSamples) {
  const double exact = 2.0 * (1.0 + std::exp(-pi * 0.05 / std::sqrt(1.0 - 0.0025)));
  for (const double dt : {0.7, 0.73, 1.1}) {
    const MotionSeries s = motion_series(record_of(dt, std::vector<double>(20, -2.0)), Baseline::none);
    const double found = response_spectrum(s, {1.0}, 0.05).front();
    EXPECT_LE(found, exact * (1.0 + 1e-12));
    EXPECT_GE(found, exact * (1.0 - 0.0031));
  }
}

TEST(ResponseSpectrum, UnevenStepsGiveTheSame) {
  const MotionComponent even = steady_sine(0.5, 10.0, 0.01);
  MotionComponent uneven = record_of(0.0, {});
  for (std::size_t k = 0; k < even.acceleration.size(); ++k) {
    uneven.times.push_back(even.time(k));
    uneven.acceleration.push_back(even.acceleration[k]);
    if (k + 1 == even.acceleration.size() || k % 3 != 0) continue;
    uneven.times.push_back(even.time(k) + 0.004);  // on the straight line to the next sample
    uneven.acceleration.push_back(0.6 * even.acceleration[k] + 0.4 * even.acceleration[k + 1]);
  }
  const std::vector<double> periods{0.1, 0.5, 2.0};
  const auto a = response_spectrum(motion_series(even, Baseline::none), periods, 0.05);
  const auto b = response_spectrum(motion_series(uneven, Baseline::none), periods, 0.05);
  for (std::size_t k = 0; k < periods.size(); ++k) EXPECT_NEAR(a[k], b[k], 2e-3 * a[k]);
}

TEST(EndJumps, AreToldFromATwentiethOfThePeak) {
  EXPECT_EQ(jumps_text(end_jumps(record_of(0.1, {0.04, 1.0, -0.04}))), "");
  EXPECT_EQ(jumps_text(end_jumps(record_of(0.1, {-0.5, 2.0, 0.0}))),
            "starts with a jump of 0.5 m/s2, 25 % of its peak");
  const GroundMotion motion("m", {0.0, 1.0, 2.0}, {{0.3, 0.4}, {-3.0, 4.0}, {1.0, 0.0}});
  EXPECT_EQ(
      jumps_text(end_jumps(motion)),
      "starts with a jump of 0.5 m/s2, 10 % of its peak, and ends with a jump of 1 m/s2, 20 % of its peak");
  EXPECT_EQ(jumps_text({}), "");
}

TEST(CutOut, KeepsTheSamplesOfTheWindow) {
  const MotionComponent c = cut_out(record_of(0.5, {0, 1, 2, 3, 4, 5}), 0.5, 2.0);
  EXPECT_EQ(c.start, 0.5);
  EXPECT_THAT(c.acceleration, testing::ElementsAre(1, 2, 3, 4));
  EXPECT_THROW(cut_out(record_of(0.5, {0, 1, 2}), 0.1, 0.4), InputError);
  EXPECT_THROW(cut_out(record_of(0.5, {0, 1, 2}), 2.0, 1.0), InputError);
}

TEST(MotionDescription, TellsOfUnusualPeaksAndJumps) {
  EXPECT_THAT(describe_motion({record_of(0.1, {0.0, 94.0, 0.0})}), HasSubstr("is the unit right?"));
  EXPECT_THAT(describe_motion({record_of(0.1, {0.0, 9e-4, 0.0})}),
              HasSubstr("9.18e-05 g; usual is 0.0001 to 3 g"));
  EXPECT_THAT(describe_motion({record_of(0.1, {0.0, 20.0, 0.0})}), testing::Not(HasSubstr("note")));
  EXPECT_THAT(describe_motion({record_of(0.1, {0.0, 1.0, 0.6})}), HasSubstr("ends with a jump of 0.6 m/s2"));
}

}  // namespace
}  // namespace keyblock::loading
