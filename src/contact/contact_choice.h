#pragma once
#include <span>

#include "contact/steady_pairs.h"

namespace keyblock::contact {

/// Which of the competitors of a pair of blocks are its contacts; the others get candidate −1. In this order:
///   1. A vertex that slid over a joint onto the face of the next block continues its contact there (joint_continuity.h).
///   2. A vertex beyond the end of an edge, or nearer to another edge, has no contact with it, unless a joint let it in (blocking.h).
///   3. Where two corners meet, one contact is left (competition.h), or two, if each vertex of parallel lines is far from the end: such
///      corners meet only because their blocks may move far in the step, and lines as good as one hold both.
///
/// end: of the candidates of the pair. What is found serves later steps where it is steady.
void choose_contacts(const SteadyPairs& steady_pairs, const CornerView& view, std::size_t end,
                     std::span<Competitor> competitors, BlockPair& pair);

}  // namespace keyblock::contact
