#pragma once
#include <span>

#include "contact/competition.h"

/// Where two corners meet, another block may be in the way of a line: the line then cannot part the corners.
namespace keyblock::contact {

/// What other blocks are to a line, near the end where two corners meet.
struct Blocking {
  /// `closed`: another block covers the edge there, or is inside the line beyond an edge of the vertex that it covers. Less than that, if both
  /// corners stand on its face: the sine of the angle at which the line pushes one of them into the face. 0: no block is in the way.
  double in_the_way = 0.0;
  bool is_beside = false;  ///< a block covers the edge that follows at that end
  bool is_in_front =
      false;  ///< and its face continues in front of this edge: what the block lets in has nowhere else to go
  static constexpr double closed = 2.0;
};
Blocking find_blocking(const CornerView& view, const BlockPair& pair, const Competitor& c);

/// As compete(), without the lines that other blocks are in the way of more than of others. A line that holds its vertex is never left out: a
/// tip that came into the mouth of a joint is in there, however little room it has once the joint closes on it.
Outcome compete_among_blocks(const CornerView& view, const BlockPair& pair,
                             std::span<Competitor* const> competitors);

/// Whether a vertex that is beyond the end of an edge, or nearer to another edge, has no contact with it. It has one where another block
/// covers the edge that follows, so that a joint lets the vertex in there, and nothing leads out.
bool is_out(const CornerView& view, const BlockPair& pair, const Competitor& c);

}  // namespace keyblock::contact
