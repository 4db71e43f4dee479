// Files of networks, made here by their public descriptions; all numbers are our own.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "motion_texts.h"

namespace keyblock::loading {
namespace {

using testing::HasSubstr;

TEST(MotionNetworks, CwaOfTaiwan) {
  const auto c = read_text(cwa_text());
  ASSERT_EQ(c.size(), 3U);
  EXPECT_EQ(c[0].format, "CWA");
  EXPECT_TRUE(c[0].vertical);
  EXPECT_EQ(c[1].azimuth, 0.0);
  EXPECT_EQ(c[2].azimuth, 90.0);
  EXPECT_EQ(c[1].dt, 0.01);
  EXPECT_NEAR(c[1].acceleration[3], 0.18, 1e-12);
  const auto down = read_text(replaced(replaced(cwa_text(), "U(+)", "U(-)"), "E(+)", "E(-)"));
  EXPECT_NEAR(down[0].acceleration[3], -c[0].acceleration[3], 1e-15);
  EXPECT_EQ(down[2].azimuth, 270.0);
  EXPECT_THAT(error_of(replaced(cwa_text(), "gal. DC", "count DC")).expected, HasSubstr("acceleration"));
}

TEST(MotionNetworks, UscOfFilmRecords) {
  const auto c = read_text(usc_text());
  ASSERT_EQ(c.size(), 2U);
  EXPECT_EQ(c[0].azimuth, 90.0);
  EXPECT_TRUE(c[1].vertical);
  ASSERT_EQ(c[0].acceleration.size(), 12U);
  EXPECT_NEAR(c[0].time(11), 0.22, 1e-12);
  EXPECT_NEAR(c[0].acceleration[11], 11.0 * 0.1 * standard_gravity, 1e-12);
  EXPECT_NEAR(c[1].acceleration[11], -11.0 * 0.1 * standard_gravity, 1e-12);  // positive downwards
  EXPECT_THROW(read_text(usc_text().substr(0, usc_text().size() - 200)), InputError);
}

TEST(MotionNetworks, BhrcOfIran) {
  const auto c = read_text(bhrc_text());
  ASSERT_EQ(c.size(), 2U);
  EXPECT_EQ(c[0].azimuth, 35.0);
  EXPECT_TRUE(c[1].vertical);
  EXPECT_NEAR(c[0].dt, 0.005, 1e-12);
  ASSERT_EQ(c[0].acceleration.size(), 21U);
  EXPECT_NEAR(c[0].acceleration[20], 2.0 * standard_gravity / 10.0, 1e-12);
  EXPECT_THROW(read_text(replaced(bhrc_text(), "* VOL1DS", "* VOL3DS")), InputError);
}

TEST(MotionNetworks, UnamOfMexico) {
  const auto c = read_text(unam_text());
  ASSERT_EQ(c.size(), 3U);
  EXPECT_EQ(c[0].azimuth, 180.0);
  EXPECT_TRUE(c[1].vertical);
  EXPECT_EQ(c[2].azimuth, 270.0);
  EXPECT_EQ(c[0].dt, 0.005);
  EXPECT_NEAR(c[2].acceleration[5], -0.05, 1e-12);
  EXPECT_TRUE(c[0].notes.empty());
  EXPECT_THROW(read_text(replaced(unam_text(), "/6/6/6", "/6/6/7")), InputError);
  EXPECT_THROW(read_text(replaced(unam_text(), "/6/6/6", "/9999/9999/9999")), InputError);
}

}  // namespace
}  // namespace keyblock::loading
