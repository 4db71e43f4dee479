// Records as people and networks write them: units and quantities in names of columns, titles, pairs, directions of AT2.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "motion_texts.h"

namespace keyblock::loading {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

MotionReading in(std::string unit) {
  MotionReading reading;
  reading.unit = std::move(unit);
  return reading;
}

TEST(MotionSpellings, UnitsInNamesOfColumns) {
  const std::pair<const char*, double> known[] = {{"acc_cms2", 0.01},
                                                  {"a_cmss", 0.01},
                                                  {"a_cm/s2", 0.01},
                                                  {"acc cm per s^2", 0.01},
                                                  {"\"Acceleration, cm per s^2\"", 0.01},
                                                  {"a (cm/s**2)", 0.01},
                                                  {"acc [cm·s⁻²]", 0.01},
                                                  {"a_mps2", 1.0},
                                                  {"a_ms-2", 1.0},
                                                  {"acc_m_s2", 1.0},
                                                  {"acc_mss", 1.0},
                                                  {"a (m/sec^2)", 1.0},
                                                  {"acc_mm_s2", 1e-3},
                                                  {"acc (% g)", 0.01 * standard_gravity},
                                                  {"acc_g", standard_gravity},
                                                  {"acc_gal_NS", 0.01}};
  for (const auto& [name, in_si] : known) {
    const auto c = read_text(fmt::format("t,{}\n0,1\n0.1,2\n", name));
    ASSERT_EQ(c.size(), 1U) << name;
    EXPECT_DOUBLE_EQ(c[0].acceleration[1], 2.0 * in_si) << name;
  }
}

TEST(MotionSpellings, FactorsBesideAUnitAreRefused) {
  for (const char* name : {"acc*10 (m/s2)", "acc (m/s2*10)", "acc_m/s2 x 10", "10*acc (m/s2)",
                           "acc (m/s2) ×100", "acc (1e-3 g)"})
    EXPECT_THAT(error_of(fmt::format("t,{}\n0,1\n0.1,2\n", name)).expected, HasSubstr("unit of acceleration"))
        << name;
}

TEST(MotionSpellings, VelocitiesAreNoAccelerations) {
  for (const char* name : {"v_cms", "v_mps", "vel_ns", "vx", "Velocity", "v (m/s)", "v_cm_s", "crown.vx",
                           "u_cm", "disp", "kine"})
    EXPECT_THAT(error_of(fmt::format("t,{}\n0,1\n0.1,2\n", name), in("m/s2")).expected,
                HasSubstr("time series of acceleration"))
        << name;
  const auto c = read_text("t,a,v,d\n0,1,2,3\n0.1,2,3,4\n", in("g"));
  ASSERT_EQ(c.size(), 1U);
  EXPECT_DOUBLE_EQ(c[0].acceleration[0], standard_gravity);
}

TEST(MotionSpellings, ATableWithoutAUnitSaysWhatToWrite) {
  for (const char* text :
       {"0,1\n0.1,2\n", "t,a\n0,1\n0.1,2\n", "time (s),acc\n0,1\n0.1,2\n", "# made by hand\n0 1\n1 2\n"}) {
    const Diagnostic error = error_of(text);
    EXPECT_THAT(error.hint, HasSubstr("unit = \"m/s2\"")) << text;
    EXPECT_DOUBLE_EQ(read_text(text, in("g"))[0].acceleration[1], 2.0 * standard_gravity) << text;
  }
}

TEST(MotionSpellings, TitlesStandAboveNames) {
  const auto c = read_text(
      "Corrected time-history\n\nRun 5 of 2020\nTime(sec) Acc(g) Vel(cm/sec) Disp(cm)\n0.00 1 2 3\n0.01 -2 3 "
      "4\n");
  ASSERT_EQ(c.size(), 1U);
  EXPECT_EQ(c[0].dt, 0.01);
  EXPECT_DOUBLE_EQ(c[0].acceleration[1], -2.0 * standard_gravity);
  const auto units = read_text("A title\nTime Acc Vel\n(s) (m/s2) (m/s)\n0 1 2\n1 2 3\n");
  EXPECT_THAT(units[0].acceleration, ElementsAre(1.0, 2.0));
}

TEST(MotionSpellings, NumberAndStepBeforeSamples) {
  const auto c = read_text("Synthetic record m/s2\n4 0.01\n0.5\n-1\n0.25\n0\n");
  ASSERT_EQ(c.size(), 1U);
  EXPECT_EQ(c[0].dt, 0.01);
  EXPECT_THAT(c[0].acceleration, ElementsAre(0.5, -1.0, 0.25, 0.0));
  EXPECT_THAT(read_text("0.02 5\n1 2 3\n4 5\n", in("g"))[0].acceleration.size(), 5U);
  EXPECT_THAT(error_of("4 0.01\n0.5\n-1\n0.25\n0\n").hint, HasSubstr("unit ="));
}

TEST(MotionSpellings, PairsOfTimeAndAcceleration) {
  std::string text = "Digitized in 1970\nUNITS: CM/SEC/SEC\n";
  for (int k = 0; k < 11; ++k)
    text += fmt::format("{:8.3f}{:9.2f}{}", 0.02 * k, 10.0 * k, k % 4 == 3 || k == 10 ? "\n" : " ");
  const auto c = read_text(text);
  ASSERT_EQ(c.size(), 1U);
  ASSERT_EQ(c[0].acceleration.size(), 11U);
  EXPECT_NEAR(c[0].dt, 0.02, 1e-12);
  EXPECT_NEAR(c[0].acceleration[10], 1.0, 1e-12);
  EXPECT_THAT(error_of(replaced(text, "UNITS: CM/SEC/SEC", "no more")).hint, HasSubstr("unit ="));
}

TEST(MotionSpellings, DirectionsOfAt2) {
  const std::pair<const char*, double> azimuths[] = {{"230", 230.0},      {"090 (USGS STATION 952)", 90.0},
                                                     {"COMP 140", 140.0}, {"S16E", 164.0},
                                                     {"N 21 E", 21.0},    {"360 DEG", 360.0},
                                                     {"A-HMC180", 180.0}, {"H-E05140", 140.0},
                                                     {"N90W", 270.0},     {"N-S", 0.0},
                                                     {"HNE", 90.0},       {"AZIMUTH = 045", 45.0},
                                                     {"N21°E", 21.0},     {"ELC-EW", 90.0},
                                                     {"West", 270.0}};
  for (const auto& [words, azimuth] : azimuths) {
    const auto c = read_text(replaced(at2_text(), "ARRAY 6, 230", fmt::format("ARRAY 6, {}", words)));
    EXPECT_EQ(c[0].azimuth, azimuth) << words;
    EXPECT_FALSE(c[0].vertical) << words;
  }
  for (const char* words : {"UP", "DWN", "VERT", "ELC-UP", "H-E05-UP", "A-HMCUP", "Comp. Up"}) {
    const auto c = read_text(replaced(at2_text(), "ARRAY 6, 230", fmt::format("ARRAY 6, {}", words)));
    EXPECT_TRUE(c[0].vertical) << words;
  }
  for (const char* words : {"FN", "LONG", "TRAN"}) {
    const auto c = read_text(replaced(at2_text(), "ARRAY 6, 230", fmt::format("ARRAY 6, {}", words)));
    EXPECT_FALSE(c[0].azimuth) << words;
  }
}

}  // namespace
}  // namespace keyblock::loading
