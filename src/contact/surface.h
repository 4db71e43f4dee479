#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::contact {

struct EdgeDivision;  // edge_curve.h

/// A straight edge of a block, or the part of one that faces one neighbour, of as many pieces as contact divides it into.
struct DividedEdge {
  int first = 0;   ///< its first piece, by the vertex where that begins; the others follow
  int pieces = 1;  ///< m
  const EdgeDivision* division = nullptr;
};

/// What a vertex is to others. A vertex at which the angle of its block exceeds 180° touches nothing:
///   - reflex: by at most 10°. The end zone is enough for a vertex of another block there (Tolerances: depth_limit · tan 5° < end_zone).
///   - concave: by more. A vertex of another block may lie in such a corner, and the edges of the corner reach past it for that.
enum class CornerKind : std::uint8_t { convex, reflex, concave };

/// Of the vertex between two edges; a straight corner, up to rounding, is convex.
inline CornerKind corner_kind(Vec2 before, Vec2 after) {
  constexpr double rounding = 1e-9, sine_concave = 0.174;
  const double sine = cross(before, after) / (norm(before) * norm(after));
  if (sine >= -rounding) return CornerKind::convex;
  return sine < -sine_concave || dot(before, after) < 0.0 ? CornerKind::concave : CornerKind::reflex;
}

/// Two blocks that have a joint of their own between them, whichever of their edges meet.
struct BlockPairJoint {
  int low = 0, high = 0;  ///< the blocks, ascending
  int joint = 0;          ///< index of its law
};

/// The outlines of all blocks as contact sees them: vertices joined by straight edges. Edge k runs from vertex k to
/// next[k], the block on its left. Blocks of order > 1 have vertices along their edges, which may curve.
struct Surface {
  std::vector<int> block_begin;             ///< vertices of block b: block_begin[b] … block_begin[b + 1]
  std::vector<std::uint8_t> present;        ///< per block: not excavated
  std::vector<std::uint8_t> fixed;          ///< per block
  std::vector<double> thickness;            ///< m, per block: area over perimeter
  std::vector<int> block, next, previous;   ///< per vertex
  std::vector<CornerKind> kind;             ///< per vertex
  std::vector<int> joint;                   ///< per edge: index of its joint law
  std::vector<BlockPairJoint> pair_joints;  ///< by blocks, ascending; it goes before that of an edge
  /// Per vertex: a straight side of its block goes on there as another joint; empty: nowhere. A contact there stands for both joints.
  std::vector<std::uint8_t> is_seam;
  /// Per edge: share that its start has of the length of joint along it, its end having the rest; empty: a half of each.
  std::vector<double> start_share;
  std::vector<DividedEdge> divided;  ///< per edge: what it is a piece of; empty: no edge is divided
  std::vector<Vec2> position;        ///< per vertex, now
  /// Basis functions at the vertices: φ(vertex) starts at phi[phi_begin[vertex]] and has the N of its block.
  std::vector<std::size_t> phi_begin;
  std::vector<double> phi;

  [[nodiscard]] bool is_reflex(std::size_t vertex) const { return kind[vertex] != CornerKind::convex; }
  [[nodiscard]] bool is_concave(std::size_t vertex) const { return kind[vertex] == CornerKind::concave; }
  /// Index of the joint law of an edge, for a contact of two blocks.
  [[nodiscard]] int joint_of(int edge, int block_a, int block_b) const {
    if (!pair_joints.empty()) {
      const auto blocks = [](const BlockPairJoint& pair) { return std::pair(pair.low, pair.high); };
      const std::pair<int, int> wanted = std::minmax(block_a, block_b);
      const auto found = std::ranges::lower_bound(pair_joints, wanted, {}, blocks);
      if (found != pair_joints.end() && blocks(*found) == wanted) return found->joint;
    }
    return joint[static_cast<std::size_t>(edge)];
  }
  [[nodiscard]] bool has_seam(int vertex) const {
    return !is_seam.empty() && is_seam[static_cast<std::size_t>(vertex)] != 0;
  }
  [[nodiscard]] int blocks() const { return static_cast<int>(block_begin.size()) - 1; }
  [[nodiscard]] int vertices() const { return static_cast<int>(block.size()); }
};

}  // namespace keyblock::contact
