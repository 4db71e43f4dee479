#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/candidates.h"
#include "contact/surface.h"
#include "core/index.h"
#include "geometry/vec2.h"

namespace keyblock::dynamics {

/// m, how deep p lies in a block whose vertices are where position() says: the distance from its outline. Negative: p lies outside.
template <typename Position>
double depth_in(const contact::Surface& surface, int block, Vec2 p, const Position& position) {
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = false;
  const std::size_t first = at(surface.block_begin[at(block)]), last = at(surface.block_begin[at(block) + 1]);
  for (std::size_t v = first; v < last; ++v) {
    const Vec2 a = position(v), b = position(at(surface.next[v]));
    nearest = std::min(nearest, contact::distance_to_segment(p, a, b));
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside ? nearest : -nearest;
}

}  // namespace keyblock::dynamics
