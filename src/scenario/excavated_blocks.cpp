#include "scenario/excavated_blocks.h"

#include <algorithm>
#include <cmath>

#include "overlap/overlap.h"

namespace keyblock::scenario {
namespace {

constexpr double area_tolerance = 1e-3;

bool apart(const Box& a, const Box& b) {
  return a.max.x <= b.min.x || b.max.x <= a.min.x || a.max.y <= b.min.y || b.max.y <= a.min.y;
}

}  // namespace

Overlay overlay(const Polygon& block, const Ring& outline) {
  const Polygon opening{outline, {}};
  if (apart(bounds(block), bounds(opening))) return {};
  const Polygon both[] = {block, opening};
  double common = 0.0;
  for (const overlap::Overlap& part : overlap::all_overlaps(both, 0.0)) common += part.area;
  const double own = area(block);
  const double smaller = std::min(own, std::abs(signed_area(outline)));
  Overlay result{Place::across, common / own};
  if (own - common <= area_tolerance * own) {
    result.place = Place::inside;
  } else if (common <= area_tolerance * smaller) {
    result.place = Place::outside;
  }
  return result;
}

}  // namespace keyblock::scenario
