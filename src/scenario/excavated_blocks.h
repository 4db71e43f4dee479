#pragma once
#include "geometry/polygon.h"

namespace keyblock::scenario {

/// Where an explicit block lies, seen from the outline of an excavation.
enum class Place { outside, across, inside };

/// By areas, as coordinates are typed with a few digits: the block is inside when the outline leaves less than 1e-3 of it
/// out, and outside when they share less than 1e-3 of the smaller of the two.
struct Overlay {
  Place place = Place::outside;
  double share = 0.0;  ///< of the block that lies inside
};
Overlay overlay(const Polygon& block, const Ring& outline);

}  // namespace keyblock::scenario
