#pragma once
#include <span>
#include <vector>

#include "geometry/polygon.h"

/// True overlap of polygons, by exact polygon intersection and apart from any contact code, which it is there to
/// check.
namespace keyblock::overlap {

/// A connected region that two polygons share.
struct Overlap {
  double depth = 0.0;  ///< m
  int block_a = -1;    ///< indices of the polygons, block_a < block_b; −1: there is no overlap
  int block_b = -1;
  Vec2 where;         ///< inside the region, where it is deepest
  double area = 0.0;  ///< m² of the region
};

/// The deepest overlap of any two of `blocks`, if it is deeper than `least_depth` (m, ≥ 0).
///
/// The depth of a region is its smallest width: the shortest way to push the two polygons apart there, if nothing
/// else is near. A region that is not convex, such as the L along both faces of a corner or the ring around an island
/// in its hole, is cut into convex parts, of which the widest counts (its hull would be as wide as the block).
///
/// Pairs are taken in the order of an upper bound, the smallest penetration of their convex hulls along an edge
/// normal or the sum of those of their convex parts, until the bound falls below the depth found. So polygons that merely touch cost little. Depths below
/// 16 ε times the largest coordinate (4e-14 m at 10 m) cannot be told from touching and count as none.
///
/// Polygons that cross themselves are read by the even-odd rule. Where no exact intersection can be had, the
/// upper bound is returned as the depth: an overlap may be overstated then, but never lost.
/// The same input gives the same bits.
Overlap largest_overlap(std::span<const Polygon> blocks, double least_depth = 0.0);

/// All overlaps deeper than `least_depth` (m, ≥ 0), deepest first.
std::vector<Overlap> all_overlaps(std::span<const Polygon> blocks, double least_depth);

/// Polygons that do not overlap and cover together what those given cover. Throws std::invalid_argument where GEOS has none.
std::vector<Polygon> union_of(std::span<const Polygon> polygons);

}  // namespace keyblock::overlap
