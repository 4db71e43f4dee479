#include "loading/motion_measures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace keyblock::loading {
namespace {

using testing::HasSubstr;
using testing::Not;

MotionComponent sine_record(double amplitude, double frequency, int cycles, int per_cycle) {
  MotionComponent c;
  c.file = "folder/<sine>.csv";
  c.format = "CSV";
  c.dt = 1.0 / frequency / per_cycle;
  c.file_unit = "m/s2";
  for (int k = 0; k <= cycles * per_cycle; ++k) {
    c.acceleration.push_back(amplitude * std::sin(2.0 * std::numbers::pi * k / per_cycle));
  }
  return c;
}

TEST(MotionMeasures, OfASine) {
  const double amplitude = 3.0, frequency = 2.0;
  const MotionMeasures m = measure(sine_record(amplitude, frequency, 10, 4000));
  EXPECT_DOUBLE_EQ(m.peak, amplitude);
  EXPECT_DOUBLE_EQ(m.peak_time, 0.125);
  EXPECT_NEAR(m.peak_velocity, amplitude / (std::numbers::pi * frequency), 1e-6);
  EXPECT_NEAR(m.final_velocity, 0.0, 1e-12);
  EXPECT_NEAR(m.arias_intensity,
              std::numbers::pi / (2.0 * standard_gravity) * amplitude * amplitude / 2.0 * 5.0, 1e-5);
  EXPECT_NEAR(m.significant_duration, 0.9 * 5.0, 1e-3);
}

// Ticks are counted: adding a step to a time of 1e17 s would never end.
TEST(MotionPlot, EndsForAnyTimes) {
  MotionComponent c;
  c.acceleration = {1.0, 2.0};
  c.times = {1e17, 1e17 + 16.0};
  EXPECT_THAT(plot_motion_svg({c}), testing::EndsWith("</svg>\n"));
  c.times = {0.0, HUGE_VAL};
  EXPECT_THAT(plot_motion_svg({c}), testing::EndsWith("</svg>\n"));
}

TEST(MotionMeasures, VelocityPeaksBetweenSamples) {
  MotionComponent c;
  c.dt = 1.0;
  c.acceleration = {1.0, -1.0};
  const MotionMeasures m = measure(c);
  EXPECT_DOUBLE_EQ(m.peak_velocity, 0.25);
  EXPECT_DOUBLE_EQ(m.final_velocity, 0.0);
  EXPECT_NEAR(m.arias_intensity, std::numbers::pi / (2.0 * standard_gravity) / 3.0, 1e-15);
}

TEST(MotionMeasures, OfSilence) {
  MotionComponent c;
  c.dt = 1.0;
  c.acceleration = {0.0, 0.0, 0.0};
  const MotionMeasures m = measure(c);
  EXPECT_EQ(m.arias_intensity, 0.0);
  EXPECT_EQ(m.significant_duration, 0.0);
  EXPECT_THAT(plot_motion_svg({c}), Not(HasSubstr("nan")));
}

// A circle of radius a ω⁻¹ about its centre: |v| = (a/ω) |2 sin(ω t/2)|, largest after half a turn.
TEST(ShakingMeasures, OfATurningAcceleration) {
  const double a = 2.0, omega = 4.0, pi = std::numbers::pi;
  std::vector<double> time;
  std::vector<Vec2> acceleration;
  for (int k = 0; k <= 4001; ++k) {  // half a turn lies between samples
    time.push_back(2.0 * pi / omega * k / 4001.0);
    acceleration.push_back({a * std::cos(omega * time.back()), a * std::sin(omega * time.back())});
  }
  const GroundMotion motion("turning", time, acceleration);
  const ShakingMeasures m = measure(motion, -3.0, motion.duration());
  EXPECT_NEAR(m.peak, 3.0 * a, 1e-12);
  EXPECT_NEAR(m.peak_velocity, 3.0 * 2.0 * a / omega, 1e-5);
  EXPECT_NEAR(m.arias_intensity, 9.0 * pi / (2.0 * standard_gravity) * a * a * motion.duration(), 1e-4);
  const ShakingMeasures quarter = measure(motion, 1.0, 0.25 * motion.duration());
  EXPECT_NEAR(quarter.peak_velocity, a / omega * std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(measure(motion, 1.0, 100.0).arias_intensity, m.arias_intensity / 9.0, 1e-12);
}

TEST(ShakingMeasures, VelocityPeaksBetweenSamples) {
  const GroundMotion motion("m", {0.0, 1.0}, {{3.0, 4.0}, {-3.0, -4.0}});
  EXPECT_NEAR(measure(motion, 1.0, 1.0).peak_velocity, 5.0 * 0.25, 1e-12);
  EXPECT_NEAR(measure(motion, 1.0, 0.25).peak_velocity, 5.0 * 0.1875, 1e-12);
}

// Velocity and acceleration change from against each other to with each other and back within one stretch between samples.
TEST(ShakingMeasures, VelocityPeaksWithinAStretchThatItTurnsRoundIn) {
  const GroundMotion motion("m", {0.0, 0.1, 0.101, 0.601}, {{1.0, 0.0}, {1.0, 0.0}, {-4.0, 0.0}, {4.0, 0.0}});
  // From 0.0985 m/s down at 4 m/s² that turns to nothing in a quarter of a second.
  EXPECT_NEAR(measure(motion, 1.0, 0.601).peak_velocity, 0.4015, 1e-9);
  EXPECT_NEAR(measure(motion, -2.0, 0.601).peak_velocity, 0.803, 1e-9);
}

TEST(MeanPeriod, IsThatOfASineAndOfASwingThatJumps) {
  std::vector<double> time;
  std::vector<Vec2> sine;
  for (int k = 0; k <= 4000; ++k) {
    time.push_back(k / 1000.0);
    const double a = std::sin(2.0 * std::numbers::pi * time.back() / 0.8);
    sine.push_back({3.0 * a, -4.0 * a});
  }
  EXPECT_NEAR(mean_period({"sine", time, sine}), 0.8, 1e-4);
  // A ramp of a thousandth of a second to a constant acceleration is no swing of that period.
  EXPECT_NEAR(mean_period({"ramp", {0.0, 0.001, 10.0}, {{}, {1.0, 0.0}, {1.0, 0.0}}}),
              2.0 * std::numbers::pi * 10.0, 0.01);
  EXPECT_EQ(mean_period({"none", {0.0, 1.0}, {{}, {}}}), 0.0);
}

TEST(MotionDescription, NamesWhatAnEngineerAsks) {
  MotionComponent c = sine_record(3.0, 2.0, 10, 100);
  c.azimuth = 270.0;
  c.notes.push_back("the file names no unit; m/s2 is assumed");
  const std::string text = describe_motion({c});
  for (const char* words :
       {"<sine>.csv: CSV", "azimuth 270°", "1001, dt 0.005 s, 5 s", "3 m/s2", "0.306 g at 0.125 s",
        "0.4773 m/s", "Arias", "5-95 % duration 4.5 s", "m/s2 is assumed"}) {
    EXPECT_THAT(text, HasSubstr(words));
  }
}

TEST(MotionPlot, IsAnSvgWithASheetPerComponent) {
  MotionComponent up = sine_record(1.0, 1.0, 5, 100), east = sine_record(3.0, 2.0, 10, 100);
  up.vertical = true;
  east.azimuth = 90.0;
  east.acceleration.back() = 1.5;
  const std::string svg = plot_motion_svg({up, east});
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns"));
  for (const char* words : {"&lt;sine&gt;.csv, up", "&lt;sine&gt;.csv, 90°", "0.306 g", "acceleration, m/s²",
                            "velocity, m/s", "displacement, m", "response spectrum of 5 % damping",
                            "build-up of the Arias intensity", "none: as recorded", "demean", "linear",
                            "taper", "It ends with a jump of 1.5 m/s2, 50 % of its peak."}) {
    EXPECT_THAT(svg, HasSubstr(words));
  }
  EXPECT_THAT(svg, testing::EndsWith("time, s</text>\n</svg>\n"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

// What drifts out of the picture is cut off, and told.
TEST(MotionPlot, ADriftDoesNotFlattenTheRest) {
  MotionComponent drifting = sine_record(1.0, 1.0, 20, 100);
  for (double& a : drifting.acceleration) a += 0.5;
  EXPECT_THAT(plot_motion_svg({drifting}), HasSubstr("velocity, m/s; drifts leave the picture"));
}

}  // namespace
}  // namespace keyblock::loading
