#include "loading/intensity_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "loading/motion_measures.h"
#include "loading/motion_series.h"

namespace keyblock::loading {
namespace {

// 1 m/s² at 2 Hz, 20 cycles, sampled at 0.005 s: numbers of an independent program, near 2A/ω, 2AT/π and (A/2ζ)(1 − e^{−ζωT}).
TEST(IntensityMeasures, OfASampledSine) {
  MotionComponent sine;
  sine.dt = 0.005;
  for (int k = 0; k <= 2000; ++k) sine.acceleration.push_back(std::sin(4.0 * std::numbers::pi * 0.005 * k));
  const MotionMeasures m = measure(sine);
  EXPECT_NEAR(m.peak_velocity / 0.159103, 1.0, 4e-6);
  EXPECT_NEAR(m.arias_intensity / 0.800356, 1.0, 1e-6);
  EXPECT_NEAR(m.absolute_velocity / 6.364103, 1.0, 1e-6);
  EXPECT_NEAR(m.significant_duration, 9.0, 1e-6);
  const MotionSeries series = motion_series(sine, Baseline::none);
  EXPECT_NEAR(response_spectrum(series, {0.5}, 0.05)[0] / 9.97842, 1.0, 1e-4);
}

TEST(IntensityMeasures, OfAllDirections) {
  std::vector<Vec2> along, both, circle;
  for (int k = 0; k <= 720; ++k) {
    const double t = 2.0 * std::numbers::pi * k / 720.0;
    along.push_back({std::sin(t), 0.0});
    both.push_back({std::sin(t), std::sin(t)});
    circle.push_back({std::sin(t), std::cos(t)});
  }
  EXPECT_NEAR(rotated(along).first, 0.70711, 2e-4);
  EXPECT_NEAR(rotated(along).second, 1.0, 2e-4);
  EXPECT_NEAR(rotated(both).first, 1.0, 1e-2 * 2.0);
  EXPECT_NEAR(rotated(both).second, 1.41421, 2e-4);
  EXPECT_NEAR(rotated(circle).first, 1.0, 2e-4);
  EXPECT_NEAR(rotated(circle).second, 1.0, 2e-4);
}

MotionComponent example(const char* name) {
  MotionComponent component =
      read_motion_file(std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "examples/motions" / name).front();
  component.acceleration.resize(6001);
  return component;
}

// The record of the examples; numbers of an independent program, which looks at the samples alone.
TEST(IntensityMeasures, OfARecord) {
  const MotionComponent h1 = example("0111a.smc"), h2 = example("0111c.smc");
  EXPECT_NEAR(measure(h1).absolute_velocity, 2.44348, 1e-4 * 2.44348);
  EXPECT_NEAR(measure(h2).absolute_velocity, 2.02144, 1e-4 * 2.02144);
  const auto horizontal =
      horizontal_motion({{h1, ComponentDirection{false, 360.0}}, {h2, ComponentDirection{false, 270.0}}}, {});
  ASSERT_TRUE(horizontal);
  const std::vector<RotatedMeasure> all = rotated_measures(*horizontal);
  const double rotd50[] = {0.86414, 0.098846, 2.83844, 0.695944},
               rotd100[] = {1.04417, 0.135204, 3.30527, 0.871099};
  const double tolerance[] = {1e-4, 2e-4, 2e-3, 2e-3};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(all[k].rotd50 / rotd50[k], 1.0, tolerance[k]) << all[k].name;
    EXPECT_NEAR(all[k].rotd100 / rotd100[k], 1.0, tolerance[k]) << all[k].name;
  }
  EXPECT_NEAR(horizontal_measures(*horizontal, -2.0).pga, 2.0 * all[0].rotd50, 1e-12);
}

// Neither the section nor the order of the components matters; one horizontal component, or two that are not at right angles, have none.
TEST(IntensityMeasures, NeedTwoComponentsAtRightAngles) {
  const MotionComponent h1 = example("0111a.smc"), h2 = example("0111c.smc");
  const ComponentDirection north{false, 0.0}, west{false, 270.0}, slanted{false, 40.0}, up{true, 0.0};
  ProjectionOptions section;
  section.section_azimuth = 165.0;
  const double one = rotated_measures(*horizontal_motion({{h1, north}, {h2, west}}, {}))[0].rotd50;
  const double other = rotated_measures(*horizontal_motion({{h2, west}, {h1, north}}, section))[0].rotd50;
  EXPECT_NEAR(one, other, 1e-12);
  EXPECT_FALSE(horizontal_motion({{h1, north}, {h2, up}}, {}));
  EXPECT_FALSE(horizontal_motion({{h1, north}, {h2, slanted}}, {}));
}

}  // namespace
}  // namespace keyblock::loading
