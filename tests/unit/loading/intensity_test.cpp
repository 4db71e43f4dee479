#include "loading/intensity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace keyblock::loading {
namespace {

IntensityName of(const char* text) {
  return intensity_named(text).value();
}

// 1 m/s² at 2 Hz, 20 cycles, sampled at 0.005 s: numbers of an independent program.
TEST(Intensity, OfASampledSine) {
  std::vector<double> time, a;
  for (int k = 0; k <= 2000; ++k) {
    time.push_back(0.005 * k);
    a.push_back(std::sin(4.0 * std::numbers::pi * 0.005 * k));
  }
  EXPECT_NEAR(intensity_along(time, a, of("PGV")) / 0.159103, 1.0, 4e-6);
  EXPECT_NEAR(intensity_along(time, a, of("IA")) / 0.800356, 1.0, 1e-6);
  EXPECT_NEAR(intensity_along(time, a, of("CAV")) / 6.364103, 1.0, 1e-6);
  EXPECT_NEAR(intensity_along(time, a, of("RSD595")), 9.0, 1e-6);
  EXPECT_NEAR(intensity_along(time, a, of("SA(0.5)")) / 9.97842, 1.0, 1e-4);
  // A sine that begins at its zero goes one way: its mean velocity is A/ω.
  EXPECT_NEAR(intensity_along(time, a, of("PGD")) / (10.0 / (4.0 * std::numbers::pi)), 1.0, 5e-4);
}

TEST(Intensity, OfDirections) {
  std::vector<double> time;
  std::vector<Vec2> along, both, circle;
  for (int k = 0; k <= 720; ++k) {
    const double t = 2.0 * std::numbers::pi * k / 720.0;
    time.push_back(t);
    along.push_back({std::sin(t), 0.0});
    both.push_back({std::sin(t), std::sin(t)});
    circle.push_back({std::sin(t), std::cos(t)});
  }
  const auto pga = [&](const std::vector<Vec2>& a, DirectionRule rule, double azimuth = 0.0) {
    return intensity_of(GroundMotion("", time, a), of("PGA"), rule, azimuth);
  };
  using enum DirectionRule;
  EXPECT_NEAR(pga(along, rotd50), 0.70711, 2e-4);
  EXPECT_NEAR(pga(along, rotd100), 1.0, 2e-4);
  EXPECT_NEAR(pga(both, rotd100), 1.41421, 2e-4);
  EXPECT_NEAR(pga(circle, rotd50), 1.0, 2e-4);
  EXPECT_NEAR(pga(both, geometric_mean), 1.0, 1e-9);
  EXPECT_NEAR(pga(both, larger, 45.0), std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(pga(both, arithmetic_mean, 45.0), std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(pga(both, geometric_mean, 45.0), 0.0, 1e-7);
  // ∫ a² goes with cos²: its median over directions is half, its largest all of it.
  const GroundMotion one("", time, along);
  EXPECT_NEAR(intensity_of(one, of("IA"), rotd50) / intensity_of(one, of("IA"), rotd100), 0.5, 1e-9);
}

TEST(Intensity, Names) {
  EXPECT_EQ(of("AvgSA(0.1,1.0)").periods.size(), 10U);
  EXPECT_DOUBLE_EQ(of("SA(0.3)").periods.front(), 0.3);
  EXPECT_EQ(of("IA").power, 2);
  EXPECT_EQ(of("RSD595").power, 0);
  for (const char* wrong : {"", "pga", "SA", "SA()", "SA(0)", "SA(0.3", "SA(0.3,1)", "AvgSA(1)",
                            "AvgSA(1,0.1)", "SA(nan)", "MMI"})
    EXPECT_FALSE(intensity_named(wrong)) << wrong;
}

}  // namespace
}  // namespace keyblock::loading
