#pragma once
#include "contact/competitor.h"

/// Vertices of two blocks near the edges of other blocks.
namespace keyblock::contact {

/// Calls call(k) with every candidate k of a vertex of `block`, except the candidates of this pair of blocks.
template <typename Call>
void for_other_candidates(const CandidateList& candidates, const BlockPair& pair, int vertex, int block,
                          const Call& call) {
  for (const int p : candidates.pairs_of(block)) {
    if (candidates.block_pairs[at(p)].first == pair.first) continue;
    const auto [first, last] = candidates.of_vertex(at(p), vertex);
    for (std::size_t k = first; k < last; ++k) call(k);
  }
}

/// Calls call(edge) with every edge of another block that the vertex is near to, or presses on. Near is near enough for a candidate, whenever
/// the block was searched last.
template <typename Call>
void for_other_edges(const CornerView& view, const BlockPair& pair, int vertex, int block, const Call& call) {
  const CandidateList& candidates = view.candidates;
  for_other_candidates(candidates, pair, vertex, block, [&](std::size_t k) {
    const Candidate& c = candidates.pairs[k];
    const Corner& edge = view.corner(c.edge);
    const Vec2 from_start = view.corner(vertex).position - edge.position;
    const double along = std::clamp(dot(edge.tangent, from_start), 0.0, edge.length),
                 near = view.tolerances.activation + view.motion.reach[at(c.block_a)] +
                        view.motion.reach[at(c.block_b)];
    const auto presses = [&] {
      const int memory = CandidateList::Finder(candidates, static_cast<int>(k))(k);
      return memory >= 0 && candidates.memory[at(memory)].holds();
    };
    if (norm(from_start - along * edge.tangent) <= near || presses()) call(c.edge);
  });
}

}  // namespace keyblock::contact
