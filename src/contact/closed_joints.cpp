// What third blocks are to the contacts of two: in the way of lines, which part no corners then, or the face that a vertex has come in by.
#include <algorithm>
#include <cmath>

#include "contact/detection.h"
#include "core/index.h"

namespace keyblock::contact {

/// Calls with every candidate of a vertex and a third block.
template <typename Call>
void Detection::for_third_candidates(const CandidateList& candidates, const BlockPair& pair, int vertex,
                                     int block, const Call& call) const {
  for (const int p : candidates.pairs_of(block)) {
    if (candidates.block_pairs[at(p)].first == pair.first) continue;
    const auto [first, last] = candidates.of_vertex(at(p), vertex);
    for (std::size_t k = first; k < last; ++k) call(k);
  }
}

/// Calls with every edge of a third block that the vertex is near to: near enough for it to be a candidate, whenever the block was looked
/// at. Or that it presses on.
template <typename Call>
void Detection::for_third_edges(const CandidateList& candidates, const BlockPair& pair, int vertex, int block,
                                const Call& call) const {
  for_third_candidates(candidates, pair, vertex, block, [&](std::size_t k) {
    const Candidate& c = candidates.pairs[k];
    const Corner& edge = corners_[at(c.edge)];
    const Vec2 from_start = corners_[at(vertex)].position - edge.position;
    const double along = std::clamp(dot(edge.tangent, from_start), 0.0, edge.length),
                 near = tolerances_.activation + motion_.reach[at(c.block_a)] + motion_.reach[at(c.block_b)];
    const auto presses = [&] {
      const int memory = CandidateList::Finder(candidates, static_cast<int>(k))(k);
      return memory >= 0 && candidates.memory[at(memory)].holds();
    };
    if (norm(from_start - along * edge.tangent) <= near || presses()) call(c.edge);
  });
}

/// Where the surface goes on at a corner one of whose edges, that beginning there or that ending there, lies against an edge of another
/// block: along that, or around its end. A joint that is open by less than the zone in which corners compete has no room for a tip. Zero:
/// the edge is open to the corner.
Vec2 Detection::beyond_joint(const Surface& surface, int corner, bool begins, int edge) const {
  const Corner &here = corners_[at(corner)], &other = corners_[at(edge)];
  const Vec2 along = begins ? here.tangent : here.before, from_start = here.position - other.position;
  if (dot(along, other.tangent) > 0.0 || std::abs(cross(along, other.tangent)) > Tolerances::sine_facing)
    return {};
  const double gap = dot(other.normal(), from_start), from_end = dot(other.tangent, from_start),
               beyond = begins ? other.length - from_end : from_end;
  const bool touches = gap <= tolerances_.end_zone && gap >= -tolerances_.depth_limit,
             reaches = beyond >= -tolerances_.corner_depth && beyond < other.length;
  if (!touches || !reaches) return {};
  // A corner that is deep behind the edge and nearer to another has not come in by this one, but gone past its end.
  if (gap < -tolerances_.corner_depth && to_nearest_other_edge(surface, corner, edge) < -gap) return {};
  if (beyond > tolerances_.corner_depth) return (begins ? 1.0 : -1.0) * other.tangent;
  return begins ? corners_[at(surface.next[at(edge)])].tangent : -1.0 * other.before;
}

/// Whether a vertex is over the face of the line's block, and that between it and an edge of a third one: the thin end of a block lets nothing
/// through to the joint below, however thin where the vertex is over that as well.
bool Detection::lies_behind(const Rival& rival, const Candidate& candidate, int edge) const {
  const Corner& other = corners_[at(edge)];
  const Vec2 from_start = corners_[at(candidate.vertex)].position - other.position;
  const bool is_over_both = inside(dot(other.tangent, from_start), other.length) > 0.0;
  return inside(rival.along, corners_[at(candidate.edge)].length) >= 0.0 &&
         dot(other.normal(), from_start) >
             std::max(0.0, rival.gap) + (is_over_both ? tolerances_.rounding : tolerances_.corner_depth);
}

/// Whether a vertex that is past the end of a face is over an edge of another block that goes on with it.
bool Detection::goes_on(const Surface& surface, int vertex, int face, int edge) const {
  const Corner &from = corners_[at(face)], &to = corners_[at(edge)];
  const Vec2 here = corners_[at(vertex)].position;
  const double along = dot(from.tangent, here - from.position);
  if (inside(along, from.length) >= 0.0 || inside(dot(to.tangent, here - to.position), to.length) < 0.0)
    return false;
  if (dot(from.tangent, to.tangent) <= 0.0 ||
      std::abs(cross(from.tangent, to.tangent)) > Tolerances::sine_facing)
    return false;
  const bool at_start = along < 0.0;
  const Vec2 joint = at_start ? corners_[at(surface.next[at(edge)])].position - from.position
                              : to.position - corners_[at(surface.next[at(face)])].position;
  return std::abs(dot(from.normal(), joint)) <= tolerances_.corner_depth &&
         std::abs(dot(from.tangent, joint)) <= tolerances_.end_zone;
}

/// A vertex that a face holds and that slides over a joint to the next block comes to be deep behind the face of that, and nearer to its
/// sides, but it has come in by the face. That takes over what held the vertex where it has left the end zone of the one before; sides do
/// not count. False where the rival, which had no contact, is such a side. rivals: of the pair.
bool Detection::take_over_joint(const Surface& surface, const CandidateList& candidates,
                                const BlockPair& pair, std::span<const Rival> rivals, Rival& rival) const {
  const Candidate& c = candidates.pairs[at(rival.candidate)];
  const auto has_left = [&](const Candidate& held) {
    const Corner& face = corners_[at(held.edge)];
    const double zone =
                     tolerances_.end_zone + motion_.reach[at(held.block_a)] + motion_.reach[at(held.block_b)],
                 along = dot(face.tangent, corners_[at(held.vertex)].position - face.position);
    return -inside(along, face.length) > std::min(zone, 0.5 * face.length);
  };
  bool counts = true;
  for_third_candidates(candidates, pair, c.vertex, c.block_a, [&](std::size_t k) {
    const Candidate& held = candidates.pairs[k];
    const int memory = CandidateList::Finder(candidates, static_cast<int>(k))(k);
    if (memory < 0 || candidates.memory[at(memory)].bonded ||
        candidates.memory[at(memory)].normal_force <= 0.0)
      return;
    if (goes_on(surface, c.vertex, held.edge, c.edge)) {
      if (has_left(held)) rival.memory = memory;
      return;
    }
    counts = counts && std::ranges::none_of(rivals, [&](const Rival& r) {
               if (r.candidate < 0) return false;
               const Candidate& other = candidates.pairs[at(r.candidate)];
               return other.vertex == c.vertex && goes_on(surface, c.vertex, held.edge, other.edge);
             });
  });
  return counts;
}

Detection::Third Detection::third(const Surface& surface, const BlockPair& pair, const Rival& rival,
                                  const CandidateList& candidates) const {
  const Candidate& c = candidates.pairs[at(rival.candidate)];
  const bool begins = rival.first_half;
  const int end = begins ? c.edge : surface.next[at(c.edge)];
  const Vec2 normal = corners_[at(c.edge)].normal();
  // Along an edge of the vertex the line is the face that two blocks share, whatever third one that goes on to.
  const bool is_face = faces(rival, candidates);
  Third found;
  const auto look_at = [&](int edge) {
    if (!is_face && squared_norm(beyond_joint(surface, end, begins, edge)) > 0.0) found.in_the_way = closed;
    const Vec2 beyond = beyond_joint(surface, end, !begins, edge);
    const bool is_in_front = dot(normal, beyond) > Tolerances::sine_inside;
    found.is_in_front = found.is_in_front || is_in_front;
    found.is_beside = found.is_beside || squared_norm(beyond) > 0.0;
    if (is_face || lies_behind(rival, c, edge)) return;
    for (const bool side : {true, false}) {
      if (dot(normal, beyond_joint(surface, c.vertex, side, edge)) >= -Tolerances::sine_inside) continue;
      const double into = is_in_front ? std::abs(dot(normal, corners_[at(edge)].normal())) : closed;
      found.in_the_way = std::max(found.in_the_way, into);
    }
  };
  for_third_edges(candidates, pair, c.vertex, c.block_a, look_at);
  for_third_edges(candidates, pair, end, c.block_b, look_at);
  return found;
}

/// Whether a vertex that is beyond the end of an edge, or nearer to another, has no contact with it: not where a third block covers the one
/// that follows, so that a joint lets it in there, and no way leads out.
bool Detection::is_out(const Surface& surface, const BlockPair& pair, const Rival& rival,
                       const CandidateList& candidates) const {
  const Third found = third(surface, pair, rival, candidates);
  if (rival.is_beyond) return !found.is_in_front;
  const std::size_t edge = at(candidates.pairs[at(rival.candidate)].edge);
  return !found.is_beside ||
         has_come_in_elsewhere(surface, rival, candidates,
                               rival.first_half ? surface.previous[edge] : surface.next[edge]);
}

/// As compete(), but for lines that third blocks are in the way of more than of others. Of none that holds its vertex: a tip that came into
/// the mouth of a joint is in there, however little room it has once the joint closes on it.
Detection::Outcome Detection::compete_in_joints(const Surface& surface, const BlockPair& pair,
                                                std::span<Rival* const> all,
                                                const CandidateList& candidates) const {
  Outcome outcome = compete(surface, all, candidates);
  if (outcome.parallel || outcome.winner == nullptr || holds(*outcome.winner, candidates)) return outcome;
  const Third of_winner = third(surface, pair, *outcome.winner, candidates);
  if (!(of_winner.in_the_way > 0.0)) return outcome;
  std::array<Third, 4> thirds{};
  double least = closed;
  for (std::size_t i = 0; i < all.size(); ++i) {
    thirds[i] = all[i] == outcome.winner ? of_winner : third(surface, pair, *all[i], candidates);
    least = std::min(least, thirds[i].in_the_way);
  }
  std::array<Rival*, 4> open{};
  std::size_t count = 0;
  Rival* in_nook = nullptr;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (thirds[i].in_the_way > least + Tolerances::sine_inside) continue;
    open[count++] = all[i];
    if (thirds[i].is_in_front) in_nook = all[i];
  }
  if (count < all.size()) outcome = compete(surface, std::span<Rival* const>(open).first(count), candidates);
  if (outcome.winner == nullptr) outcome.winner = in_nook;
  outcome.left_out = count < all.size();
  return outcome;
}

}  // namespace keyblock::contact
