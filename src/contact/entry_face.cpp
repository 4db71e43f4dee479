#include "contact/entry_face.h"

namespace keyblock::contact {

NearEdge nearest_other_edge(const CornerView& view, int vertex, int edge, int except) {
  const Surface& surface = view.surface;
  const Vec2 from = view.corner(vertex).position;
  double nearest = HUGE_VAL, gap = 0.0;
  const auto measure = [&](int k) {
    if (k == except) return;
    const Corner& other = view.corner(k);
    const Vec2 from_start = from - other.position;
    const double along = std::clamp(dot(other.tangent, from_start), 0.0, other.length),
                 distance = squared_norm(from_start - along * other.tangent);
    if (distance >= nearest) return;
    nearest = distance;
    gap = dot(other.normal(), from_start);
  };
  int k = surface.next[at(edge)];
  for (; k != edge && !surface.is_reflex(at(k)); k = surface.next[at(k)]) measure(k);
  if (k != edge) {
    for (k = edge; !surface.is_reflex(at(k));) measure(k = surface.previous[at(k)]);
  }
  return {std::sqrt(nearest), gap};
}

bool has_come_in_elsewhere(const CornerView& view, const Competitor& competitor, int except) {
  if (competitor.gap >= -entry_depth(view, competitor)) return false;
  const Candidate& c = view.candidate(competitor);
  const bool is_here = has_come_in_here(view, competitor);
  // Until it has left the end zone, what has come in here stays; beyond, where a joint goes on there (except).
  const double zone = view.tolerances.end_zone + view.reach(c.block_a, c.block_b);
  const bool is_over = except >= 0 || inside(view, competitor) >= -zone;
  if (is_here && is_over && competitor.gap >= -view.surface.thickness[at(c.block_b)]) return false;
  const NearEdge nearest = nearest_other_edge(view, c.vertex, c.edge, except);
  // It has slid past the end of the face that has held it, or through the block.
  if (is_here) return nearest.distance < HUGE_VAL && nearest.gap > zone;
  if (nearest.distance >= -competitor.gap) return false;
  // In front of the nearest edge the vertex is not in the block: it has gone around the end of the face, whatever runs along the face. Where a
  // block slides out of a plane wall its face and that of the wall stay parallel.
  if (nearest.gap > view.tolerances.corner_depth) return true;
  // Along the edge, away from the end that is nearer to the vertex.
  const Vec2 inwards = (competitor.first_half ? 1.0 : -1.0) * view.corner(c.edge).tangent;
  for (const Vec2 side : view.sides(c.vertex)) {
    if (dot(side, inwards) > 0.0 && std::abs(cross(side, inwards)) < Tolerances::sine_facing) return false;
  }
  return true;
}

}  // namespace keyblock::contact
