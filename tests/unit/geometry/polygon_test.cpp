#include "geometry/polygon.h"

#include <gtest/gtest.h>

#include "geometry/moments.h"
#include "shapes.h"

namespace keyblock {
namespace {

TEST(Polygon, AreaPerimeterCentroid) {
  EXPECT_DOUBLE_EQ(area(frame), 11.0);
  EXPECT_DOUBLE_EQ(perimeter(frame), 18.0);
  EXPECT_DOUBLE_EQ(centroid(frame).x, (12.0 * 2.0 - 1.5) / 11.0);
  EXPECT_DOUBLE_EQ(area(l_shape), 4.0);
}

TEST(Polygon, CentroidFarFromOriginKeepsItsDigits) {
  Polygon moved = l_shape;
  const Vec2 far{466000.0, 6691600.0};
  for (Vec2& p : moved.outer) p += far;
  EXPECT_NEAR(norm(centroid(moved) - far - centroid(l_shape)), 0.0, 1e-9);
  EXPECT_NEAR(area(moved), 4.0, 1e-8);
}

TEST(Polygon, Contains) {
  EXPECT_TRUE(contains(frame, {0.5, 0.5}));
  EXPECT_FALSE(contains(frame, {1.5, 1.5}));
  EXPECT_FALSE(contains(l_shape, {1.5, 1.5}));
}

TEST(Polygon, OrientTurnsRings) {
  Polygon p{{{0, 0}, {0, 1}, {1, 1}, {1, 0}}, {{{0.2, 0.2}, {0.4, 0.2}, {0.4, 0.4}}}};
  orient(p);
  EXPECT_GT(signed_area(p.outer), 0.0);
  EXPECT_LT(signed_area(p.holes[0]), 0.0);
}

TEST(Polygon, SelfIntersection) {
  EXPECT_FALSE(self_intersects(frame));
  EXPECT_TRUE(self_intersects({{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {}}));
  EXPECT_TRUE(self_intersects({{{0, 0}, {2, 0}, {1, 0}, {1, 1}}, {}}));  // a spike
}

TEST(Moments, CentreAndScaleAreThoseAsked) {
  const Moments moments(l_shape, {0.5, 0.25}, 2.0, 4);
  EXPECT_NEAR(moments(0, 0), 4.0, 1e-14);
  const Vec2 c = centroid(l_shape);
  EXPECT_NEAR(moments(1, 0), 4.0 * (c.x - 0.5) / 2.0, 1e-14);
  EXPECT_NEAR(moments(0, 1), 4.0 * (c.y - 0.25) / 2.0, 1e-14);
}

}  // namespace
}  // namespace keyblock
