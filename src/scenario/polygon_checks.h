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

}  // namespace keyblock::scenario
