#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "contact/candidate_list.h"
#include "contact/contact.h"
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

/// A block that rolls comes to lie on its next vertex, and the contact of the last one ends, as the edge between them turns into the face.
/// While it is pressed in deep, the next vertex is as deep by then, or deeper, and was no contact before. So the contact of the last one
/// goes on as its contact, with the same stretch and energy of its springs: the rest of the depth is offset. Where the next vertex presses
/// already, it takes the energy over. Only contacts deeper than the end zone are looked at. At the end of a step, once blocks are where
/// they come to be. contacts: of the step, as many as are tracked.
void hand_over_to_next_vertices(const Surface& surface, const Tolerances& tolerances,
                                std::span<const Contact> contacts, CandidateList& candidates);

}  // namespace keyblock::contact
