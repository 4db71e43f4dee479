#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "contact/candidate_list.h"
#include "contact/surface.h"
#include "contact/tolerances.h"
#include "core/index.h"

/// Blocks that are pressed deep into each other, as soft joints let them be. They may roll meanwhile.
namespace keyblock::contact {

/// m, per block: how deep contacts of the last step press its vertices in, or press vertices into it, where that is more than half of the depth
/// limit, else 0. Empty: there is no such contact.
std::vector<double> pressed_depths(const CandidateList& candidates, const Tolerances& tolerances,
                                   std::size_t blocks);

/// Of two blocks: what each of them has.
inline double pressed_depth(std::span<const double> depths, int block_a, int block_b) {
  return depths.empty() ? 0.0 : std::min(depths[at(block_a)], depths[at(block_b)]);
}

/// Contacts of the last step whose vertices were pressed in by more than the end zone: candidates, ascending. What lay in the other block
/// before it pressed (Memory::offset) is not pressed in, nor is what in-situ stress has closed.
std::vector<int> deep_contacts(const CandidateList& candidates, const Tolerances& tolerances);

/// Those of a pair of blocks, which has the candidates from first to end.
inline std::span<const int> of_pair(std::span<const int> deep, std::size_t first, std::size_t end) {
  const auto from = std::ranges::lower_bound(deep, static_cast<int>(first)),
             to = std::lower_bound(from, deep.end(), static_cast<int>(end));
  return {from, to};
}

/// Of a vertex: the edge that begins at it, and the one that ends there.
struct SidesOfVertex {
  bool next = false, previous = false;
};

/// A vertex touches a line only where its own edges lie outside it: what lies inside would be in the other block. Where blocks are pressed deep
/// into each other, it is. So an edge of the vertex may lie inside that leads to a deep contact, as the outline goes on into the line: to a
/// vertex that presses, or to an edge that a vertex presses on, in about the direction in which the line parts the blocks. A block that rolls while it is deep is met
/// by the face with its next vertex when that comes to the face, and its last one is held until it has left the face.
///
/// deep: of the pair of blocks.
SidesOfVertex sides_to_deep(const Surface& surface, const CandidateList& candidates,
                            std::span<const int> deep, const Candidate& candidate);

}  // namespace keyblock::contact
