#include "geometry/polygon.h"

#include <gtest/gtest.h>

#include "geometry/moments.h"

namespace keyblock {
namespace {

const Polygon frame{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
const Polygon l_shape{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, {}};

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

TEST(Triangulate, CoversExactly) {
  for (const Polygon& polygon : {frame, l_shape}) {
    double sum = 0.0;
    for (const auto& t : triangulate(polygon)) {
      const double a = signed_area(t);
      EXPECT_GT(a, 0.0);
      sum += a;
    }
    EXPECT_NEAR(sum, area(polygon), 1e-14);
  }
  EXPECT_THROW(triangulate({{{0, 0}, {1, 1}}, {}}), std::invalid_argument);
}

// Both holes are joined to the vertex on the right, of which there are then two copies: one above, one below the bridge.
TEST(Triangulate, TwoHolesSeeTheSameVertex) {
  for (const double y : {-0.6, 0.6}) {
    Polygon polygon{{{-3, -1.2}, {0, -1.2}, {2, 0}, {0, 1.2}, {-3, 1.2}},
                    {{{-1, -0.1}, {1, 0}, {-1, 0.1}}, {{-1.2, y - 0.1}, {0.2, y}, {-1.2, y + 0.1}}}};
    orient(polygon);
    ASSERT_FALSE(self_intersects(polygon));
    double sum = 0.0;
    for (const auto& t : triangulate(polygon)) sum += signed_area(t);
    EXPECT_NEAR(sum, area(polygon), 1e-14) << y;
  }
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
