#include "contact/joint_pieces.h"

#include <algorithm>
#include <utility>

#include "contact/surface.h"
#include "core/index.h"

namespace keyblock::contact {

int piece_of_new_contact(const JointPieces& pieces, const Surface& surface, int vertex, int edge) {
  const auto key = [](const JointPiece& piece) { return std::pair(piece.vertex, piece.edge); };
  const auto own = std::ranges::lower_bound(pieces, std::pair(vertex, edge), {}, key);
  if (own != pieces.end() && key(*own) == std::pair(vertex, edge))
    return static_cast<int>(own - pieces.begin());
  const auto joint_of = [&](int of_vertex, int of_edge) {
    return surface.joint_of(of_edge, surface.block[at(of_vertex)], surface.block[at(of_edge)]);
  };
  const auto shares = [&](const JointPiece& piece) {
    return piece.is_touched && (piece.vertex == vertex || piece.edge == edge) &&
           joint_of(piece.vertex, piece.edge) == joint_of(vertex, edge);
  };
  const JointPiece* least = nullptr;
  for (const JointPiece& piece : pieces) {
    if (shares(piece) && (least == nullptr || piece.worn < least->worn)) least = &piece;
  }
  return least == nullptr ? -1 : static_cast<int>(least - pieces.data());
}

}  // namespace keyblock::contact
