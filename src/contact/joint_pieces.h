#pragma once
#include <vector>

namespace keyblock::contact {

struct Surface;

/// A piece of a joint in place whose law has memory (JointLaw::has_memory). It belongs to the rock, not to the contact: it stays when its contact
/// ends, and a vertex that leaves its edge does not take it along.
struct JointPiece {
  int vertex = 0, edge = 0;  ///< of its first contact
  double worn = 0.0;         ///< m, slip that has worn it
  bool is_touched = false;   ///< it had a contact in the last step
};

/// Pieces ascend by vertex, then edge; a contact holds the number of its piece (Memory::piece). None without laws that have memory.
using JointPieces = std::vector<JointPiece>;

/// The piece that a contact gets which was none in the last step:
///
///     1. that of its own vertex and edge, however long it has been apart: blocks that hop come down on the joint that they left;
///     2. else, of the pieces of the same law that share its vertex or its edge and had a contact in the last step, the least worn: a block that
///        slides goes on over the vertices of the other side;
///     3. else none, −1: the contact is made later, where no joint was.
int piece_of_new_contact(const JointPieces& pieces, const Surface& surface, int vertex, int edge);

}  // namespace keyblock::contact
