#include "contact/blocking.h"

#include "contact/entry_face.h"
#include "contact/other_blocks.h"

namespace keyblock::contact {

namespace {

/// Where the surface continues at a corner that has an edge against an edge of another block: along the other edge, or around its end. The
/// edge of the corner is the one that begins there, or the one that ends there. A joint that is open by less than the end zone has no room
/// for a tip. Zero: the edge is open to the corner.
Vec2 beyond_joint(const CornerView& view, int corner, bool begins, int edge) {
  const Tolerances& tolerances = view.tolerances;
  const Corner &here = view.corner(corner), &other = view.corner(edge);
  const Vec2 along = begins ? here.tangent : here.before, from_start = here.position - other.position;
  if (dot(along, other.tangent) > 0.0 || std::abs(cross(along, other.tangent)) > Tolerances::sine_facing)
    return {};
  const double gap = dot(other.normal(), from_start), from_end = dot(other.tangent, from_start),
               beyond = begins ? other.length - from_end : from_end;
  const bool touches = gap <= tolerances.end_zone && gap >= -tolerances.depth_limit,
             reaches = beyond >= -tolerances.corner_depth && beyond < other.length;
  if (!touches || !reaches) return {};
  // A corner that is deep behind the edge and nearer to another edge has not come in by this one, but gone past its end.
  if (gap < -tolerances.corner_depth && distance_to_other_edges(view, corner, edge) < -gap) return {};
  if (beyond > tolerances.corner_depth) return (begins ? 1.0 : -1.0) * other.tangent;
  return begins ? view.corner(view.surface.next[at(edge)]).tangent : -1.0 * other.before;
}

/// Whether a vertex is over the face of the block of the line, and the face is between the vertex and an edge of another block. The thin end
/// of a block lets nothing through to the joint below, however thin where the vertex is over the other edge as well.
bool lies_behind(const CornerView& view, const Competitor& competitor, int edge) {
  const Candidate& c = view.candidate(competitor);
  const Corner& other = view.corner(edge);
  const Vec2 from_start = view.corner(c.vertex).position - other.position;
  const bool is_over_both = inside(dot(other.tangent, from_start), other.length) > 0.0;
  return inside(competitor.along, view.corner(c.edge).length) >= 0.0 &&
         dot(other.normal(), from_start) >
             std::max(0.0, competitor.gap) +
                 (is_over_both ? view.tolerances.rounding : view.tolerances.corner_depth);
}

}  // namespace

Blocking find_blocking(const CornerView& view, const BlockPair& pair, const Competitor& competitor) {
  const Candidate& c = view.candidate(competitor);
  const bool begins = competitor.first_half;
  const int end = begins ? c.edge : view.surface.next[at(c.edge)];
  const Vec2 normal = view.corner(c.edge).normal();
  // Along an edge of the vertex the line is the face that two blocks share, whatever other block it continues to.
  const bool is_face = faces(view, competitor);
  Blocking found;
  const auto check = [&](int edge) {
    if (!is_face && squared_norm(beyond_joint(view, end, begins, edge)) > 0.0)
      found.in_the_way = Blocking::closed;
    const Vec2 beyond = beyond_joint(view, end, !begins, edge);
    const bool is_in_front = dot(normal, beyond) > Tolerances::sine_inside;
    found.is_in_front = found.is_in_front || is_in_front;
    found.is_beside = found.is_beside || squared_norm(beyond) > 0.0;
    if (is_face || lies_behind(view, competitor, edge)) return;
    for (const bool side : {true, false}) {
      if (dot(normal, beyond_joint(view, c.vertex, side, edge)) >= -Tolerances::sine_inside) continue;
      const double into = is_in_front ? std::abs(dot(normal, view.corner(edge).normal())) : Blocking::closed;
      found.in_the_way = std::max(found.in_the_way, into);
    }
  };
  for_other_edges(view, pair, c.vertex, c.block_a, check);
  for_other_edges(view, pair, end, c.block_b, check);
  return found;
}

Outcome compete_among_blocks(const CornerView& view, const BlockPair& pair,
                             std::span<Competitor* const> all) {
  Outcome outcome = compete(view, all);
  if (outcome.each) {
    // Beside a closed joint tips slide over the joint: only lines that nothing else is beside hold together.
    outcome.each = std::ranges::none_of(all, [&](const Competitor* c) {
      const Blocking found = find_blocking(view, pair, *c);
      return found.is_beside || found.in_the_way > 0.0;
    });
  }
  if (outcome.parallel || outcome.winner == nullptr || holds_vertex(view, *outcome.winner)) return outcome;
  const Blocking of_winner = find_blocking(view, pair, *outcome.winner);
  if (!(of_winner.in_the_way > 0.0)) return outcome;
  std::array<Blocking, most_competitors> blocking{};
  double least = Blocking::closed;
  for (std::size_t i = 0; i < all.size(); ++i) {
    blocking[i] = all[i] == outcome.winner ? of_winner : find_blocking(view, pair, *all[i]);
    least = std::min(least, blocking[i].in_the_way);
  }
  std::array<Competitor*, most_competitors> open{};
  std::size_t count = 0;
  Competitor* in_front = nullptr;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (blocking[i].in_the_way > least + Tolerances::sine_inside) continue;
    open[count++] = all[i];
    if (blocking[i].is_in_front) in_front = all[i];
  }
  if (count < all.size()) outcome = compete(view, std::span<Competitor* const>(open).first(count));
  outcome.each = false;
  if (outcome.winner == nullptr) outcome.winner = in_front;
  outcome.left_out = count < all.size();
  return outcome;
}

bool is_out(const CornerView& view, const BlockPair& pair, const Competitor& c) {
  const Blocking found = find_blocking(view, pair, c);
  if (c.is_beyond) return !found.is_in_front;
  const std::size_t edge = at(view.candidate(c).edge);
  return !found.is_beside ||
         has_come_in_elsewhere(view, c, c.first_half ? view.surface.previous[edge] : view.surface.next[edge]);
}

}  // namespace keyblock::contact
