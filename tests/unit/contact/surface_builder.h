#pragma once
#include "contact/surface.h"
#include "geometry/polygon.h"

namespace keyblock::contact {

/// A surface of order-1 blocks without basis values, for tests of geometry alone.
inline void add_block(Surface& surface, const Polygon& polygon, bool fixed = false) {
  if (surface.block_begin.empty()) surface.block_begin.push_back(0);
  const int number = surface.blocks();
  for (std::size_t r = 0; r < polygon.ring_count(); ++r) {
    const Ring& ring = polygon.ring(r);
    const int first = surface.vertices(), count = static_cast<int>(ring.size());
    for (int k = 0; k < count; ++k) {
      const auto at = [&](int i) { return ring[static_cast<std::size_t>((i + count) % count)]; };
      surface.block.push_back(number);
      surface.joint.push_back(0);
      surface.position.push_back(at(k));
      surface.kind.push_back(corner_kind(at(k) - at(k - 1), at(k + 1) - at(k)));
      surface.next.push_back(first + (k + 1) % count);
      surface.previous.push_back(first + (k + count - 1) % count);
    }
  }
  surface.block_begin.push_back(surface.vertices());
  surface.thickness.push_back(area(polygon) / perimeter(polygon));
  surface.present.push_back(1);
  surface.fixed.push_back(fixed);
}

inline Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, {}};
}

}  // namespace keyblock::contact
