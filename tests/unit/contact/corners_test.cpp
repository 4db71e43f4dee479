#include "contact/corners.h"

#include <gtest/gtest.h>

#include <numbers>

#include "contact/edge_curve.h"
#include "surface_builder.h"

namespace keyblock::contact {
namespace {

TEST(Corners, MeasureEdgesAndKinds) {
  Surface surface;
  // An L: its vertex 3 is a concave corner.
  add_block(surface, {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, {}});
  add_block(surface, {{{4, 0}, {7, 4}, {3, 4}}, {}});
  ThreadTeam alone(1);
  Corners corners;
  corners.measure(surface, alone);
  ASSERT_EQ(corners.all().size(), 9U);
  EXPECT_TRUE(corners.whole_edges().empty());
  const Corner& slope = corners.all()[6];
  EXPECT_EQ(slope.position, (Vec2{4, 0}));
  EXPECT_DOUBLE_EQ(slope.length, 5.0);
  EXPECT_DOUBLE_EQ(slope.tangent.x, 0.6);
  EXPECT_DOUBLE_EQ(slope.tangent.y, 0.8);
  EXPECT_DOUBLE_EQ(slope.normal().x, 0.8);
  EXPECT_DOUBLE_EQ(slope.normal().y, -0.6);
  for (std::size_t v = 0; v < 9; ++v) {
    const Vec2 before = corners.all()[static_cast<std::size_t>(surface.previous[v])].tangent;
    EXPECT_EQ(corners.all()[v].before, before) << v;
  }
  const double concave = static_cast<double>(CornerKind::concave);
  EXPECT_EQ(corners.all()[3].kinds, concave);
  EXPECT_EQ(corners.all()[2].kinds, 4.0 * concave);
  EXPECT_EQ(corners.all()[0].kinds, 0.0);
}

TEST(Corners, PiecesKnowTheirWholeEdge) {
  Surface surface;
  add_block(surface, {{{0, 0}, {1, 0}, {2, 0}, {2, 1}}, {}});
  const EdgeDivision halves({0.0, 0.5, 1.0});
  surface.divided = {{0, 2, &halves}, {0, 2, &halves}, {2, 1, nullptr}, {3, 1, nullptr}};
  surface.start_share = {0.3, 0.6, 0.5, 0.5};
  ThreadTeam alone(1);
  Corners corners;
  corners.measure(surface, alone);
  ASSERT_EQ(corners.whole_edges().size(), 4U);
  for (const std::size_t piece : {0U, 1U}) {
    const WholeEdge& whole = corners.whole_edges()[piece];
    EXPECT_EQ(whole.from, (Vec2{0, 0}));
    EXPECT_EQ(whole.to, (Vec2{2, 0}));
    EXPECT_EQ(whole.start_share, surface.start_share[piece]);
    EXPECT_EQ(whole.pieces, 2.0);
  }
  EXPECT_EQ(corners.whole_edges()[2].from, (Vec2{2, 0}));
  EXPECT_EQ(corners.whole_edges()[3].to, (Vec2{0, 0}));
}

}  // namespace
}  // namespace keyblock::contact
