#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"
#include "loading/ground_motion.h"
#include "loading/projection.h"

namespace keyblock::loading {
namespace {

using testing::ElementsAre;

MotionComponent component(double dt, std::vector<double> samples) {
  MotionComponent c;
  c.file = "made.csv";
  c.dt = dt;
  c.acceleration = std::move(samples);
  return c;
}

std::string error_key(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.diagnostics().front().key;
  }
  return "no error";
}

TEST(GroundMotion, IsLinearBetweenSamplesAndZeroOutside) {
  const GroundMotion motion("m", {0.0, 1.0, 3.0}, {{1.0, 0.0}, {3.0, -2.0}, {-1.0, 2.0}});
  EXPECT_EQ(motion.at(0.0), (Vec2{1.0, 0.0}));
  EXPECT_EQ(motion.at(0.5), (Vec2{2.0, -1.0}));
  EXPECT_EQ(motion.at(2.0), (Vec2{1.0, 0.0}));
  EXPECT_EQ(motion.at(3.0), (Vec2{-1.0, 2.0}));
  EXPECT_EQ(motion.at(-1e-9), (Vec2{}));
  EXPECT_EQ(motion.at(3.0 + 1e-9), (Vec2{}));
  EXPECT_DOUBLE_EQ(motion.peak(), std::sqrt(13.0));
  EXPECT_DOUBLE_EQ(motion.duration(), 3.0);
  EXPECT_DOUBLE_EQ(GroundMotion().duration(), 0.0);
  EXPECT_EQ(GroundMotion().mean(0.0, 1.0), (Vec2{}));
}

TEST(GroundMotion, MeanIsExact) {
  const GroundMotion motion("m", {0.0, 1.0, 3.0}, {{1.0, 0.0}, {3.0, -2.0}, {-1.0, 2.0}});
  EXPECT_NEAR(motion.mean(0.0, 3.0).x, (2.0 + 2.0) / 3.0, 1e-15);
  EXPECT_NEAR(motion.mean(0.5, 2.0).x, (0.5 * 2.5 + 1.0 * 2.0) / 1.5, 1e-15);
  EXPECT_NEAR(motion.mean(0.25, 0.5).x, 1.75, 1e-15);
  EXPECT_NEAR(motion.mean(-1.0, 1.0).x, 1.0, 1e-15);
  EXPECT_NEAR(motion.mean(2.0, 5.0).x, 0.0, 1e-15);
  EXPECT_EQ(motion.mean(4.0, 5.0), (Vec2{}));
  EXPECT_EQ(motion.mean(0.5, 0.5), motion.at(0.5));
}

// Steps that cover the motion gain its whole velocity, whatever their size and whether or not they hit
// samples.
TEST(GroundMotion, MeansOverStepsAddUpToTheVelocity) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> time;
  std::vector<Vec2> a;
  for (int k = 0; k <= 400; ++k) {
    time.push_back(0.005 * k);
    a.push_back({uniform(random), uniform(random)});
  }
  const GroundMotion motion("m", time, a);
  Vec2 exact;
  for (std::size_t k = 1; k < a.size(); ++k) exact += 0.5 * (time[k] - time[k - 1]) * (a[k] + a[k - 1]);
  for (const double h : {0.002, 0.005, 0.0001, 0.0371, 0.9, 3.0}) {
    Vec2 sum;
    for (double t = 0.0; t < 2.0; t += h) sum += h * motion.mean(t, t + h);
    EXPECT_NEAR(sum.x, exact.x, 1e-13) << h;
    EXPECT_NEAR(sum.y, exact.y, 1e-13) << h;
  }
}

TEST(GroundMotion, TwoSamplesOfOneTimeAreAJump) {
  const GroundMotion motion("m", {0.0, 1.0, 1.0, 2.0}, {{2, 0}, {2, 0}, {-2, 0}, {-2, 0}});
  EXPECT_EQ(motion.at(0.999).x, 2.0);
  EXPECT_EQ(motion.at(1.0).x, -2.0);
  EXPECT_DOUBLE_EQ(motion.mean(0.0, 1.0).x, 2.0);
  EXPECT_DOUBLE_EQ(motion.mean(1.0, 2.0).x, -2.0);
  EXPECT_DOUBLE_EQ(motion.mean(0.5, 1.5).x, 0.0);
  EXPECT_DOUBLE_EQ(motion.mean(0.75, 1.75).x, -1.0);
}

TEST(GroundMotion, RefusesTimesThatDoNotAscendFromZero) {
  EXPECT_THROW(GroundMotion("m", {0.0, 1.0, 0.5}, {{}, {}, {}}), std::invalid_argument);
  EXPECT_THROW(GroundMotion("m", {0.1, 1.0}, {{}, {}}), std::invalid_argument);
  EXPECT_THROW(GroundMotion("m", {0.0, 1.0}, {{}}), std::invalid_argument);
}

TEST(Projection, AddsCosinesOfAzimuthsToTheSection) {
  const auto north = component(1.0, {1.0, 1.0}), west = component(1.0, {10.0, 10.0}),
             up = component(1.0, {0.5, 0.25});
  const std::vector<std::pair<MotionComponent, ComponentDirection>> all{
      {north, {false, 360.0}}, {west, {false, 270.0}}, {up, {true, 0.0}}};
  const double azimuth = 165.0;
  const GroundMotion motion = project_motion("m", all, {azimuth, {}, 2.0, Baseline::none});
  const double radians = std::numbers::pi / 180.0;
  EXPECT_NEAR(motion.at(0.0).x, 2.0 * (std::cos(195.0 * radians) + 10.0 * std::cos(105.0 * radians)), 1e-14);
  EXPECT_DOUBLE_EQ(motion.at(0.0).y, 1.0);
  EXPECT_DOUBLE_EQ(motion.at(1.0).y, 0.5);
  // Exact along and across the section.
  EXPECT_EQ(project_motion("m", {{north, {false, 360.0}}}, {}).at(0.0).x, 1.0);
  EXPECT_EQ(project_motion("m", {{north, {false, 360.0}}}, {90.0}).at(0.0).x, 0.0);
  EXPECT_EQ(project_motion("m", {{north, {false, 0.0}}}, {180.0}).at(0.0).x, -1.0);
}

TEST(Projection, ShorterComponentsEndInZeros) {
  const GroundMotion motion = project_motion(
      "m", {{component(1.0, {1, 1, 1, 1, 1}), {true, 0.0}}, {component(1.0, {2, 2}), {false, 0.0}}}, {});
  EXPECT_DOUBLE_EQ(motion.duration(), 4.0);
  EXPECT_DOUBLE_EQ(motion.at(1.0).x, 2.0);
  EXPECT_DOUBLE_EQ(motion.at(1.5).x, 1.0);
  EXPECT_DOUBLE_EQ(motion.at(2.0).x, 0.0);
  EXPECT_DOUBLE_EQ(motion.at(3.5).x, 0.0);
  EXPECT_DOUBLE_EQ(motion.at(3.5).y, 1.0);
}

TEST(Projection, MergesTheTimesOfDifferentSteps) {
  std::vector<double> fine, coarse;
  for (int k = 0; k <= 600; ++k) fine.push_back(std::sin(0.1 * k));
  for (int k = 0; k <= 300; ++k) coarse.push_back(std::cos(0.3 * k));
  const auto a = component(0.005, fine), b = component(0.01, coarse);
  const GroundMotion both = project_motion("m", {{a, {false, 0.0}}, {b, {true, 0.0}}}, {});
  EXPECT_EQ(both.times().size(), 601U);  // every second time of one is a time of the other, rounding apart
  const GroundMotion alone = project_motion("m", {{a, {false, 0.0}}}, {});
  const GroundMotion other = project_motion("m", {{b, {true, 0.0}}}, {});
  for (double t = 0.0; t < 3.0; t += 0.00137) {
    EXPECT_NEAR(both.at(t).x, alone.at(t).x, 1e-6);
    EXPECT_NEAR(both.at(t).y, other.at(t).y, 1e-6);
  }
  const GroundMotion odd =
      project_motion("m", {{a, {false, 0.0}}, {component(0.007, coarse), {true, 0.0}}}, {});
  // 601 and 301 times, of which those of every 0.035 s are common, and one after the end of the shorter record.
  EXPECT_EQ(odd.times().size(), 601U + 301U - 61U + 1U);
  EXPECT_NEAR(odd.at(0.0105).y, 0.5 * (coarse[1] + coarse[2]), 1e-12);
}

TEST(Projection, WindowRestartsTime) {
  const auto c = component(1.0, {0, 1, 2, 3, 4, 5});
  const GroundMotion motion = project_motion("m", {{c, {false, 0.0}}}, {0.0, std::pair{1.5, 4.25}});
  EXPECT_THAT(motion.times(), ElementsAre(0.0, 0.5, 1.5, 2.5, 2.75));
  EXPECT_DOUBLE_EQ(motion.at(0.0).x, 1.5);
  EXPECT_DOUBLE_EQ(motion.at(2.75).x, 4.25);
  using Window = std::pair<double, double>;
  const std::vector<Window> wrong{{-1.0, 2.0}, {1.0, 5.5}, {2.0, 2.0}, {3.0, 2.0}, {std::nan(""), 2.0}};
  for (const Window& window : wrong) {
    EXPECT_EQ(error_key([&] { project_motion("m", {{c, {false, 0.0}}}, {0.0, window}); }), "window");
  }
}

TEST(Projection, ARecordOfOneSampleHasNoDuration) {
  EXPECT_EQ(error_key([] {
              project_motion("m", {{component(1.0, {1.0}), {false, 0.0}}}, {});
            }),
            "components");
}

TEST(Projection, Baselines) {
  std::vector<double> samples;
  for (int k = 0; k <= 1000; ++k) samples.push_back(std::sin(0.05 * k) + 0.3 + 0.0007 * k);
  const auto c = component(0.01, samples);
  const auto ends = [&](Baseline baseline) {
    const GroundMotion m = project_motion("m", {{c, {false, 0.0}}}, {0.0, {}, 1.0, baseline});
    double v = 0.0, u = 0.0;
    for (std::size_t k = 1; k < m.times().size(); ++k) {
      const double h = m.times()[k] - m.times()[k - 1];
      const double a = m.accelerations()[k - 1].x, b = m.accelerations()[k].x;
      u += h * v + h * h * (2.0 * a + b) / 6.0;
      v += 0.5 * h * (a + b);
    }
    return std::pair{v, u};
  };
  EXPECT_GT(std::abs(ends(Baseline::none).first), 1.0);
  EXPECT_NEAR(ends(Baseline::demean).first, 0.0, 1e-12);
  EXPECT_GT(std::abs(ends(Baseline::demean).second), 1.0);
  EXPECT_NEAR(ends(Baseline::linear).first, 0.0, 1e-12);
  EXPECT_NEAR(ends(Baseline::linear).second, 0.0, 1e-11);
  const GroundMotion taper = project_motion("m", {{c, {false, 0.0}}}, {0.0, {}, 1.0, Baseline::taper});
  EXPECT_EQ(taper.at(0.0).x, 0.0);
  EXPECT_EQ(taper.at(10.0).x, 0.0);
  EXPECT_NEAR(taper.at(0.25).x, 0.5 * samples[25], 1e-12);
  EXPECT_EQ(taper.at(0.5).x, samples[50]);
  EXPECT_EQ(taper.at(5.0).x, samples[500]);
}

TEST(TableMotion, TablesInXAndY) {
  const GroundMotion motion = table_motion("m", {{0.0, 0.0}, {2.0, 4.0}}, {{1.0, 3.0}, {3.0, 3.0}});
  EXPECT_DOUBLE_EQ(motion.duration(), 3.0);
  EXPECT_EQ(motion.at(0.5), (Vec2{1.0, 0.0}));
  EXPECT_EQ(motion.at(1.5), (Vec2{3.0, 3.0}));
  EXPECT_EQ(motion.at(2.5), (Vec2{0.0, 3.0}));
  EXPECT_DOUBLE_EQ(motion.mean(0.0, 3.0).x, 4.0 / 3.0);
  EXPECT_DOUBLE_EQ(motion.mean(0.0, 3.0).y, 2.0);
  // A square wave.
  const GroundMotion square = table_motion("m", {{0, 2}, {1, 2}, {1, -2}, {2, -2}}, {});
  EXPECT_DOUBLE_EQ(square.mean(0.0, 1.0).x, 2.0);
  EXPECT_DOUBLE_EQ(square.mean(0.0, 2.0).x, 0.0);
}

TEST(TableMotion, WrongTablesNameTheirKey) {
  EXPECT_EQ(error_key([] { table_motion("m", {}, {}); }), "x");
  EXPECT_EQ(error_key([] { table_motion("m", {{0, 1}}, {}); }), "x");
  EXPECT_EQ(error_key([] { table_motion("m", {}, {{0, 1}, {2, 1}, {1, 1}}); }), "y");
  EXPECT_EQ(error_key([] { table_motion("m", {}, {{-1, 1}, {2, 1}}); }), "y");
  EXPECT_EQ(error_key([] { table_motion("m", {}, {{0, NAN}, {2, 1}}); }), "y");
  EXPECT_EQ(error_key([] { sine_table({1.0, 0.0, 1.0}); }), "frequency");
  EXPECT_EQ(error_key([] { sine_table({1.0, 1.0, -1.0}); }), "cycles");
  EXPECT_EQ(error_key([] { sine_table({1.0, 1.0, 1e9}); }), "cycles");
  EXPECT_EQ(error_key([] { sine_table({INFINITY, 1.0, 1.0}); }), "amplitude");
}

TEST(TableMotion, SineIsCloseEverywhereAndPeaksExactly) {
  const Sine sine{2.0, 3.0, 2.25};
  const GroundMotion motion = table_motion("m", sine_table(sine), {});
  EXPECT_DOUBLE_EQ(motion.duration(), 0.75);
  EXPECT_DOUBLE_EQ(motion.peak(), 2.0);
  double worst = 0.0;
  for (double t = 0.0; t < 0.75; t += 0.000137) {
    worst = std::max(worst, std::abs(motion.at(t).x - 2.0 * std::sin(2.0 * std::numbers::pi * 3.0 * t)));
  }
  EXPECT_LT(worst, 5e-6 * 2.0);
  EXPECT_DOUBLE_EQ(motion.at(0.75).x, 2.0);
  EXPECT_NEAR(motion.mean(0.0, 2.0 / 3.0).x, 0.0, 1e-15);
}

}  // namespace
}  // namespace keyblock::loading
