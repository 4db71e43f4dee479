#pragma once
#include <vector>

#include "cutting/block_system.h"

namespace keyblock::census {

/// What lies beyond a face, in the place of the number of a block: nothing, or what the model ends at.
constexpr int nothing = -1, edge_of_domain = -2;

/// The part of an edge of a block that has one thing beyond it. Lengths in m, local coordinates.
struct Face {
  Vec2 from, to;  ///< the whole edge; the block is on its left
  cutting::EdgeLabel label;
  int beyond = nothing;  ///< number of a block, or `nothing`, or `edge_of_domain`
  double length = 0.0;   ///< that it has of the edge

  [[nodiscard]] double edge_length() const { return norm(to - from); }
  /// Unit vector along the edge, and out of the block.
  [[nodiscard]] Vec2 along() const { return normalized(to - from); }
  [[nodiscard]] Vec2 out() const { return -perpendicular(along()); }
};

/// m: 1e-4 of the block size, the root of the mean area. Corners that are nearer to each other, or to an edge, are not told apart: coordinates are
/// typed with a few digits, and cutting drops corners that are nearly in line.
double touching_distance(const cutting::BlockSystem& system);

/// The faces of every block, edge by edge, ring by ring. Two edges lie against each other where they run in opposite directions and are no
/// farther apart than the touching distance. What is left of an edge has `edge_of_domain` beyond it where it is labelled so, and else
/// `nothing`.
std::vector<std::vector<Face>> find_faces(const cutting::BlockSystem& system);

}  // namespace keyblock::census
