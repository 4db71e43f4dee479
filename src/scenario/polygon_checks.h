#pragma once
#include <optional>
#include <string>

#include "geometry/polygon.h"

namespace keyblock::scenario {

/// What is wrong with a polygon, in words.
struct PolygonFault {
  bool in_holes = false;
  std::string text;
};

/// Turns the rings the right way round. Faults: no area, a ring that crosses or touches another or itself, a hole
/// outside or in another hole.
std::optional<PolygonFault> orient_and_check(Polygon& polygon);

/// Whether p lies on the boundary, to 1e-6 of the perimeter: coordinates are typed with a few digits.
bool lies_on_boundary(const Polygon& polygon, Vec2 p);
/// Whether p lies inside or on the boundary.
bool lies_in(const Polygon& polygon, Vec2 p);

}  // namespace keyblock::scenario
