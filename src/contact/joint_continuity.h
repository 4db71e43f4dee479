#pragma once
#include <span>

#include "contact/competitor.h"

/// A vertex that slides along a face and over the joint at its end comes to the face of the next block.
namespace keyblock::contact {

/// Whether the vertex, which is past the end of `face`, is over an edge of another block that continues the face.
bool continues(const CornerView& view, int vertex, int face, int edge);

/// A vertex that has slid over a joint is deep behind the face of the next block, and nearer to its sides. But it has come in by the face.
/// So the face takes over the memory of the contact before, once the vertex has left the end zone of that; sides do not count.
///
/// False where the competitor, which had no contact, is such a side. competitors: of the pair.
bool take_over_joint(const CornerView& view, const BlockPair& pair, std::span<const Competitor> competitors,
                     Competitor& competitor);

}  // namespace keyblock::contact
