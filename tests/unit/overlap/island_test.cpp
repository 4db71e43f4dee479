#include <gtest/gtest.h>

#include "overlap/overlap.h"

namespace keyblock::overlap {
namespace {

// A triangular block in its hole, pressed by a fraction of a micrometre on all sides: the region that the two share is a
// ring too thin to be cut into convex parts. Its width must not be taken for that of the whole triangle.
TEST(Overlap, RingAroundAnIslandIsAsThinAsItIs) {
  const Ring island{{9.71887, 4.27695}, {9.70201, 4.32194}, {9.67134, 4.28111}};
  Polygon host{{{9.0, 4.0}, {10.0, 4.0}, {10.0, 5.0}, {9.0, 5.0}}, {{}}};
  const Vec2 centre = centroid({island, {}});
  for (const double shrink : {1e-8, 2e-6, 1e-5, 1e-3}) {
    host.holes[0].clear();
    for (auto p = island.rbegin(); p != island.rend(); ++p) host.holes[0].push_back(lerp(*p, centre, shrink));
    const Overlap found = largest_overlap(std::vector<Polygon>{host, {island, {}}});
    EXPECT_LT(found.depth, 0.03 * shrink + 5e-6) << shrink;
    if (shrink > 1e-6) {
      EXPECT_GT(found.depth, 0.005 * shrink);
    }
  }
}

}  // namespace
}  // namespace keyblock::overlap
