#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "scenario/sections.h"
#include "scenario_text.h"

namespace keyblock::scenario {
namespace {

TEST(Outline, CircleAndHorseshoe) {
  ExcavationSpec circle;
  circle.center = {1.0, 2.0};
  circle.diameter = 4.0;
  const Ring ring = excavation_outline(circle);
  EXPECT_EQ(ring.size(), 96U);
  EXPECT_NEAR(signed_area(ring), 4.0 * std::numbers::pi, 0.01);
  for (const Vec2 p : ring) EXPECT_NEAR(norm(p - circle.center), 2.0, 1e-12);

  ExcavationSpec horseshoe;
  horseshoe.shape = ExcavationShape::horseshoe;
  horseshoe.invert = {1.0, 0.0};
  horseshoe.width = 4.0;
  horseshoe.wall_height = 1.0;
  const Ring arch = excavation_outline(horseshoe);
  EXPECT_NEAR(signed_area(arch), 4.0 + 2.0 * std::numbers::pi, 0.01);
  EXPECT_NEAR(bounds({arch, {}}).max.y, 3.0, 1e-12);
  horseshoe.arch_height = 1.0;
  // Circular segment: r = 2.5, half angle 53.13°, area r²(α − sin α cos α).
  const double alpha = std::atan2(2.0, 1.5);
  const double segment = 6.25 * (alpha - std::sin(alpha) * std::cos(alpha));
  EXPECT_NEAR(signed_area(excavation_outline(horseshoe)), 4.0 + segment, 0.01);
  horseshoe.wall_height = 0.0;
  Polygon low{excavation_outline(horseshoe), {}};
  EXPECT_NEAR(area(low), segment, 0.01);
  EXPECT_FALSE(self_intersects(low));
}

TEST(Domain, HasExtentsThatCuttingCanTellApart) {
  using testing::HasSubstr;
  for (const char* x : {"[0, 1e-300]", "[0, 1e-7]", "[0, 1e12]", "[1e12, 1000000000000.5]", "[0, 4e6]"}) {
    EXPECT_THAT(mistakes(jointed_domain, {std::string("domain.x=") + x}), HasSubstr("an extent of")) << x;
  }
  EXPECT_EQ(mistakes(jointed_domain, {"domain.x=[466000, 466004]"}), "");
}

TEST(Outline, HasNoMoreChordsThanCanBeCut) {
  EXPECT_THAT(mistakes(runnable_domain, {"excavation.tunnel.chords=1000000000"}),
              testing::HasSubstr("expected an integer from 8 to 10000"));
}

// The halves of a bow tie have no area together, but that is not what is wrong with it.
TEST(Polygons, ThatCrossThemselvesSaySo) {
  EXPECT_THAT(mistakes(two_blocks, {"block.top.outer=[[1, 1], [3, 2], [3, 1], [1, 2]]"}),
              testing::HasSubstr("crosses or touches itself"));
  EXPECT_THAT(mistakes(two_blocks, {"block.top.outer=[[1, 1], [3, 2], [5, 3], [4, 2.5]]"}),
              testing::HasSubstr("without area"));
}

TEST(Blocks, AreTurnedBeforeTheRun) {
  const auto top = [](const std::string& key) { return parse(two_blocks, {key}).blocks[1].polygon.outer; };
  const Ring about_centroid = top("block.top.rotation=90.0");
  const Ring expected{{2.5, 0.5}, {2.5, 2.5}, {1.5, 2.5}, {1.5, 0.5}};
  ASSERT_EQ(about_centroid.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_LT(norm(about_centroid[k] - expected[k]), 1e-12);
  const Ring about_corner = parse(two_blocks, {"block.top.rotation=90.0", "block.top.rotation_center=[1, 1]"})
                                .blocks[1]
                                .polygon.outer;
  EXPECT_LT(norm(about_corner[0] - Vec2{1.0, 1.0}), 1e-12);
  EXPECT_LT(norm(about_corner[1] - Vec2{1.0, 3.0}), 1e-12);
}

TEST(Blocks, FixedOnesFollowAPrescribedMotion) {
  const auto setup = build_setup(parse(two_blocks, {"block.base.motion={x = [[0, 0], [1, 0.5]]}"}), 0);
  EXPECT_EQ(setup.properties[0].motion_x(0.5), 0.25);
  EXPECT_TRUE(setup.properties[0].motion_y.empty());
  EXPECT_TRUE(setup.properties[1].motion_x.empty());
}

}  // namespace
}  // namespace keyblock::scenario
