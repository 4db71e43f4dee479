#include "rockmass/section.h"

#include <gtest/gtest.h>

namespace keyblock::rockmass {
namespace {

TEST(Section, PublishedSets) {
  EXPECT_NEAR(apparent_dip(79, 270, 165), -53.092, 5e-4);
  EXPECT_NEAR(trace_spacing_factor(79, 270, 165), 3.1473, 5e-5);
  EXPECT_NEAR(apparent_dip(81, 230, 165), 69.456, 5e-4);
  EXPECT_NEAR(trace_spacing_factor(81, 230, 165), 2.2433, 5e-5);
}

TEST(Section, AgreesWithTheTangentRule) {
  for (double dip = 5.0; dip < 90.0; dip += 10.0) {
    for (double direction = 0.0; direction < 360.0; direction += 15.0) {
      const double expected = std::atan(std::tan(radians(dip)) * std::cos(radians(direction - 30.0)));
      EXPECT_NEAR(radians(apparent_dip(dip, direction, 30.0)), expected, 1e-12);
    }
  }
}

TEST(Section, AcrossTheStrikeEverythingIsTrue) {
  EXPECT_NEAR(apparent_dip(40, 120, 120), 40.0, 1e-12);
  EXPECT_NEAR(apparent_dip(40, 120, 300), -40.0, 1e-12);
  EXPECT_NEAR(trace_spacing_factor(40, 120, 120), 1.0, 1e-12);
}

TEST(Section, VerticalAndParallelPlanes) {
  EXPECT_NEAR(apparent_dip(90, 45, 0), 90.0, 1e-12);
  EXPECT_NEAR(trace_spacing_factor(90, 60, 0), 2.0, 1e-12);
  EXPECT_GT(trace_spacing_factor(90, 90, 0), 1e6);
}

}  // namespace
}  // namespace keyblock::rockmass
