#include "contact/joint_continuity.h"

#include "contact/other_blocks.h"

namespace keyblock::contact {

bool continues(const CornerView& view, int vertex, int face, int edge) {
  const Corner &from = view.corner(face), &to = view.corner(edge);
  const Vec2 here = view.corner(vertex).position;
  const double along = dot(from.tangent, here - from.position);
  if (inside(along, from.length) >= 0.0 || inside(dot(to.tangent, here - to.position), to.length) < 0.0)
    return false;
  if (dot(from.tangent, to.tangent) <= 0.0 ||
      std::abs(cross(from.tangent, to.tangent)) > Tolerances::sine_facing)
    return false;
  const bool at_start = along < 0.0;
  const Vec2 joint = at_start ? view.corner(view.surface.next[at(edge)]).position - from.position
                              : to.position - view.corner(view.surface.next[at(face)]).position;
  return std::abs(dot(from.normal(), joint)) <= view.tolerances.corner_depth &&
         std::abs(dot(from.tangent, joint)) <= view.tolerances.end_zone;
}

namespace {

/// Whether the vertex of a contact of the last step has left the end zone of its edge.
bool has_left(const CornerView& view, const Candidate& held) {
  const Corner& face = view.corner(held.edge);
  const double zone = view.tolerances.end_zone + view.motion.reach[at(held.block_a)] +
                      view.motion.reach[at(held.block_b)],
               along = dot(face.tangent, view.corner(held.vertex).position - face.position);
  return -inside(along, face.length) > std::min(zone, 0.5 * face.length);
}

}  // namespace

bool take_over_joint(const CornerView& view, const BlockPair& pair, std::span<const Competitor> competitors,
                     Competitor& competitor) {
  const CandidateList& candidates = view.candidates;
  const Candidate& c = view.candidate(competitor);
  const auto another_continues = [&](int face) {
    return std::ranges::any_of(competitors, [&](const Competitor& r) {
      if (r.candidate < 0) return false;
      const Candidate& other = view.candidate(r);
      return other.vertex == c.vertex && continues(view, c.vertex, face, other.edge);
    });
  };
  bool counts = true;
  for_other_candidates(candidates, pair, c.vertex, c.block_a, [&](std::size_t k) {
    const Candidate& held = candidates.pairs[k];
    const int memory = CandidateList::Finder(candidates, static_cast<int>(k))(k);
    if (memory < 0 || candidates.memory[at(memory)].bonded ||
        candidates.memory[at(memory)].normal_force <= 0.0)
      return;
    if (continues(view, c.vertex, held.edge, c.edge)) {
      if (has_left(view, held)) competitor.memory = memory;
      return;
    }
    counts = counts && !another_continues(held.edge);
  });
  return counts;
}

}  // namespace keyblock::contact
