#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "motion_texts.h"

// Files in the form of those that networks and programs write. They hold the same signal.
namespace keyblock::loading {
namespace {

struct PublicFile {
  const char* name;
  const char* format;
  const char* unit;
  std::optional<double> azimuth;
  bool vertical;
};

TEST(PublicMotions, AllAreTheSameSignal) {
  const PublicFile files[] = {{"comment-gal.txt", "table", "cm/s2", {}, true},
                              {"cosmos-end-mark.v1", "COSMOS V2", "cm/s2", 360.0, false},
                              {"csmip-lower-case.V2", "CSMIP V2", "cm/s2", 360.0, false},
                              {"esm-hne.ASC", "ESM or ITACA", "cm/s2", 90.0, false},
                              {"header-cm_s2.csv", "table", "cm/s2", {}, false},
                              {"knet.NS", "K-NET", "cm/s2", 0.0, false},
                              {"peer-direction-E.AT2", "PEER AT2", "g", 90.0, false},
                              {"peer-direction-EW.AT2", "PEER AT2", "g", 90.0, false},
                              {"peer-direction-N.AT2", "PEER AT2", "g", 0.0, false},
                              {"peer-direction-NS.AT2", "PEER AT2", "g", 0.0, false},
                              {"peer-direction-UD.AT2", "PEER AT2", "g", {}, true},
                              {"peer-filter-points.AT2", "PEER AT2", "g", 164.0, false},
                              {"peer-unit-in-words.AT2", "PEER AT2", "cm/s2", 90.0, false}};
  for (const PublicFile& file : files) {
    SCOPED_TRACE(file.name);
    const auto components = read_motion_file(motion_data / "public" / file.name);
    const MotionComponent& c = components.front();
    EXPECT_EQ(c.format, file.format);
    EXPECT_EQ(c.file_unit, file.unit);
    EXPECT_EQ(c.azimuth, file.azimuth);
    EXPECT_EQ(c.vertical, file.vertical);
    EXPECT_EQ(c.acceleration.size(), 400U);
    EXPECT_NEAR(c.dt, 0.01, 1e-15);
    EXPECT_NEAR(c.acceleration[c.peak_index()], -0.942165, 5e-6);
    EXPECT_NEAR(c.time(c.peak_index()), 1.76, 1e-12);
    EXPECT_EQ(c.notes.size(), std::string(file.name) == "comment-gal.txt" ? 1U : 0U);
  }
}

TEST(PublicMotions, AllChannelsOfAVolume2) {
  const auto components = read_motion_file(motion_data / "public/csmip-lower-case.V2");
  ASSERT_EQ(components.size(), 3U);
  EXPECT_TRUE(components[1].vertical);
  EXPECT_EQ(components[2].azimuth, 90.0);
  EXPECT_NEAR(components[1].acceleration[components[1].peak_index()], -0.47108, 1e-5);
  EXPECT_NEAR(components[2].acceleration[components[2].peak_index()], 0.75373, 1e-5);
}

}  // namespace
}  // namespace keyblock::loading
