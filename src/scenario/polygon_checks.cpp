#include "scenario/polygon_checks.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyblock::scenario {
namespace {

// Areas under this share of the squared perimeter are no areas.
constexpr double flat_ratio = 1e-10;

// Whether all vertices lie on one line.
bool is_flat(const Ring& ring) {
  const double length = perimeter({ring, {}});
  const auto far = std::max_element(ring.begin(), ring.end(), [&](Vec2 p, Vec2 q) {
    return squared_norm(p - ring.front()) < squared_norm(q - ring.front());
  });
  const Vec2 along = *far - ring.front();
  return std::all_of(ring.begin(), ring.end(), [&](Vec2 p) {
    return std::abs(cross(along, p - ring.front())) <= flat_ratio * length * length;
  });
}

}  // namespace

std::optional<PolygonFault> orient_and_check(Polygon& polygon) {
  // The two halves of a bow tie may have no area together. Corners on one line touch, but have no area in the first place.
  if (!is_flat(polygon.outer) && self_intersects({polygon.outer, {}}))
    return PolygonFault{false, "a polygon that crosses or touches itself"};
  for (std::size_t k = 0; k < polygon.ring_count(); ++k) {
    const double length = perimeter({polygon.ring(k), {}});
    if (std::abs(signed_area(polygon.ring(k))) > flat_ratio * length * length) continue;
    if (k == 0) return PolygonFault{false, "a polygon without area"};
    return PolygonFault{true, fmt::format("a hole without area (holes[{}])", k - 1)};
  }
  orient(polygon);
  if (self_intersects(polygon))
    return PolygonFault{true, "a hole that crosses or touches another ring or itself"};
  for (std::size_t k = 0; k < polygon.holes.size(); ++k) {
    const Vec2 p = polygon.holes[k].front();
    if (!contains(polygon.outer, p)) {
      return PolygonFault{true, fmt::format("a hole outside the outer ring (holes[{}])", k)};
    }
    for (std::size_t j = 0; j < polygon.holes.size(); ++j) {
      if (j == k || !contains(polygon.holes[j], p)) continue;
      return PolygonFault{true, fmt::format("a hole inside a hole (holes[{}])", k)};
    }
  }
  return std::nullopt;
}

}  // namespace keyblock::scenario
