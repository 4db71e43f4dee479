#pragma once
#include <span>
#include <vector>

#include "geometry/polygon.h"

namespace keyblock::overlap {

/// Convex hull, counter-clockwise, without collinear points (Andrew's monotone chain). Fewer than three points when
/// the input has no area.
Ring convex_hull(std::span<const Vec2> points);

/// Smallest distance between two parallel lines that hold a convex counter-clockwise ring between them; it is found
/// with one line along an edge. 0 for fewer than three points.
double convex_width(std::span<const Vec2> ring);

/// Convex polygons that cover the polygon: a triangulation whose pieces are joined while they stay convex (Hertel &
/// Mehlhorn 1983). Throws std::invalid_argument for a polygon without area.
std::vector<Ring> convex_parts(const Polygon& polygon);

/// Least overlap, over all edge normals of both, of the shadows of two convex rings: no less than the smallest
/// width of their intersection, and ≤ 0 when they are apart.
double hull_penetration(std::span<const Vec2> a, std::span<const Vec2> b);

}  // namespace keyblock::overlap
