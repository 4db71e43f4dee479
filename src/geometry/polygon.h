#pragma once
#include <array>
#include <span>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock {

/// A closed ring of vertices; the last one is joined to the first and not repeated.
using Ring = std::vector<Vec2>;

/// A region with holes. Invariant wherever a Polygon is passed on: the outer ring runs counter-clockwise,
/// every hole clockwise, rings do not cross. The region is on the left of every edge.
struct Polygon {
  Ring outer;
  std::vector<Ring> holes;

  [[nodiscard]] std::size_t ring_count() const { return 1 + holes.size(); }
  /// Ring 0 is the outer ring, ring k the hole k − 1.
  [[nodiscard]] const Ring& ring(std::size_t k) const { return k == 0 ? outer : holes[k - 1]; }
  [[nodiscard]] Ring& ring(std::size_t k) { return k == 0 ? outer : holes[k - 1]; }
};

/// Area, positive when the ring runs counter-clockwise. m².
double signed_area(std::span<const Vec2> ring);
double area(const Polygon& polygon);
double perimeter(const Polygon& polygon);
Vec2 centroid(const Polygon& polygon);
Box bounds(const Polygon& polygon);
/// Whether p lies inside (even-odd over all rings). Points exactly on the boundary may go either way.
bool contains(const Polygon& polygon, Vec2 p);
bool contains(std::span<const Vec2> ring, Vec2 p);
/// Whether p lies on the boundary, to 1e-6 of the perimeter: coordinates are typed with a few digits.
bool lies_on_boundary(const Polygon& polygon, Vec2 p);
/// Whether p lies inside or on the boundary.
bool lies_in(const Polygon& polygon, Vec2 p);
/// Reverses rings where needed so that the invariant of Polygon holds.
void orient(Polygon& polygon);
/// Whether two edges of the polygon cross or touch apart from neighbours at their common vertex; all pairs,
/// O(n²).
bool self_intersects(const Polygon& polygon);

/// Triangles between vertices of the polygon that cover it exactly (ear clipping after holes are joined to the outer
/// ring), counter-clockwise. Rings may touch at common vertices as long as the region stays connected.
/// Throws std::invalid_argument for a ring of fewer than three vertices or of no area, and for rings that break the
/// invariant, so that the areas of the triangles do not add up.
std::vector<std::array<Vec2, 3>> triangulate(const Polygon& polygon);

}  // namespace keyblock
