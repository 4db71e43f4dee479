#include "loading/liner.h"

#include <gtest/gtest.h>

namespace keyblock::loading {
namespace {

struct Known {
  SectionStrength section;
  double least, largest, tip, tip_moment, moment, shear;  // kN/m and kNm/m
};

// Capacity diagrams of three sections by hand: M = (f_c/F − N/t) t²/6, (f_t/F + N/t) t²/6, V² = (4/9) t² f/F (f/F ∓ N/t).
const Known sections[] = {
    {{0.2, 25e6, 2e6, 1.0}, -400.0, 5000.0, 2300.0, 90.0, 13.333333, 266.666667},
    {{0.3, 35e6, 3e6, 1.5}, -600.0, 7000.0, 3200.0, 190.0, 30.0, 400.0},
    {{0.1, 30e6, 2.5e6, 1.2}, -208.333333, 2500.0, 1145.833333, 22.569444, 3.472222, 138.888889}};

TEST(SectionStrength, HasTheDiagramOfAPlainRectangle) {
  for (const Known& known : sections) {
    const auto corners = known.section.moments();
    ASSERT_EQ(corners.size(), 3u);
    EXPECT_NEAR(corners[0].first / 1e3, known.least, 1e-6);
    EXPECT_NEAR(corners[1].first / 1e3, known.tip, 1e-6);
    EXPECT_NEAR(corners[1].second / 1e3, known.tip_moment, 1e-6);
    EXPECT_NEAR(corners[2].first / 1e3, known.largest, 1e-6);
    EXPECT_NEAR(known.section.shear(0.0) / 1e3, known.shear, 1e-6);
  }
}

TEST(SectionStrength, IsUsedUpOnTheEdgeOfTheDiagram) {
  for (const Known& known : sections) {
    const SectionStrength& s = known.section;
    EXPECT_NEAR(s.utilization({-1e3 * known.tip, 1e3 * known.tip_moment, 0.0}), 1.0, 1e-6);
    EXPECT_NEAR(s.utilization({0.0, -1e3 * known.moment, 0.0}), 1.0, 1e-6);
    EXPECT_NEAR(s.utilization({-1e3 * known.largest, 0.0, 0.0}), 1.0, 1e-6);
    EXPECT_NEAR(s.utilization({-1e3 * known.least, 0.0, 0.0}), 1.0, 1e-6);
    for (const double compression : {0.9 * known.least, 0.0, known.tip, 0.9 * known.largest})
      EXPECT_NEAR(s.utilization({-1e3 * compression, 0.0, s.shear(1e3 * compression)}), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace keyblock::loading
