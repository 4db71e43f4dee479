#include "simulation/openings.h"

#include <algorithm>
#include <cmath>

#include "overlap/overlap.h"

namespace keyblock::simulation {
namespace {

Vec2 nearest_on_edge(Vec2 a, Vec2 b, Vec2 p) {
  const Vec2 along = b - a;
  const double length = squared_norm(along);
  return length > 0.0 ? a + std::clamp(dot(p - a, along) / length, 0.0, 1.0) * along : a;
}

}  // namespace

record::WallPart part_towards(Vec2 out, Vec2 down) {
  const double below = dot(out, down), right = cross(down, out);
  if (std::abs(below) >= std::abs(right))
    return below > 0.0 ? record::WallPart::invert : record::WallPart::crown;
  return right > 0.0 ? record::WallPart::right : record::WallPart::left;
}

void Openings::unite(std::span<const Excavation> excavations, std::span<const std::uint8_t> open) {
  std::vector<Polygon> outlines;
  for (std::size_t e = 0; e < excavations.size(); ++e) {
    if (open[e] != 0) outlines.push_back({excavations[e].outline, {}});
  }
  openings_ = overlap::union_of(outlines);
}

double Openings::area() const {
  double sum = 0.0;
  for (const Polygon& opening : openings_) sum += keyblock::area(opening);
  return sum;
}

double Openings::area_inside(const Polygon& block) const {
  double sum = 0.0;
  for (const Polygon& opening : openings_) {
    if (!bounds(opening).overlaps(bounds(block))) continue;
    const Polygon pair[] = {block, opening};
    for (const overlap::Overlap& piece : overlap::all_overlaps(pair, 0.0)) sum += piece.area;
  }
  return sum;
}

Openings::Place Openings::behind_walls(const Polygon& block, Vec2 down) const {
  Place deepest;
  for (const Vec2 corner : block.outer) {
    Vec2 out;
    double nearest = HUGE_VAL;
    for (const Polygon& opening : openings_) {
      for (std::size_t r = 0; r < opening.ring_count(); ++r) {
        const Ring& ring = opening.ring(r);
        for (std::size_t k = 0; k < ring.size(); ++k) {
          const Vec2 apart = corner - nearest_on_edge(ring[k], ring[(k + 1) % ring.size()], corner);
          if (norm(apart) >= nearest) continue;
          nearest = norm(apart);
          out = apart;
        }
      }
    }
    if (!std::isfinite(nearest) || (deepest.part != record::WallPart::none && nearest <= deepest.depth))
      continue;
    deepest = {nearest, part_towards(out, down)};
  }
  return deepest;
}

}  // namespace keyblock::simulation
