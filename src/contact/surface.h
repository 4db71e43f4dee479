#pragma once
#include <cstdint>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::contact {

struct EdgeDivision;  // edge_curve.h

/// A straight edge of a block of order > 1, of as many pieces as contact divides it into.
struct DividedEdge {
  int first = 0;   ///< its first piece, by the vertex where that begins; the others follow
  int pieces = 1;  ///< m
  const EdgeDivision* division = nullptr;
};

/// The outlines of all blocks as contact sees them: vertices joined by straight edges. Edge k runs from vertex k to
/// next[k], the block on its left. Blocks of order > 1 have vertices along their edges, which may curve.
struct Surface {
  std::vector<int> block_begin;            ///< vertices of block b: block_begin[b] … block_begin[b + 1]
  std::vector<std::uint8_t> present;       ///< per block: not excavated
  std::vector<std::uint8_t> fixed;         ///< per block
  std::vector<double> thickness;           ///< m, per block: area over perimeter
  std::vector<int> block, next, previous;  ///< per vertex
  std::vector<std::uint8_t>
      reflex;  ///< per vertex: the block's angle there exceeds 180°; such a vertex touches nothing
  std::vector<int> joint;  ///< per edge: index of its joint law
  /// Per edge: share that its start has of the length of joint along it, its end having the rest; empty: a half of each.
  std::vector<double> start_share;
  std::vector<DividedEdge> divided;  ///< per edge: what it is a piece of; empty: no edge is divided
  std::vector<Vec2> position;        ///< per vertex, now
  /// Basis functions at the vertices: φ(vertex) starts at phi[phi_begin[vertex]] and has the N of its block.
  std::vector<std::size_t> phi_begin;
  std::vector<double> phi;

  [[nodiscard]] int blocks() const { return static_cast<int>(block_begin.size()) - 1; }
  [[nodiscard]] int vertices() const { return static_cast<int>(block.size()); }
};

/// What a joint resists with, per edge label. Stiffness is that of the pair of blocks where it is not given.
struct JointLaw {
  double friction_coefficient = 0.0;
  double cohesion = 0.0;          ///< Pa, of contacts in place until they slip or open
  double tension = 0.0;           ///< Pa, likewise
  double normal_stiffness = 0.0;  ///< Pa/m; 0: [solver] penalty × E, of the softer of the two blocks
  double stiffness_ratio = 0.4;   ///< shear over normal
  bool fused = false;             ///< an outline of an excavation not yet opened: rock on both sides is one

  friend bool operator==(const JointLaw&, const JointLaw&) = default;
  /// Whether contacts in place are bonded.
  [[nodiscard]] bool may_bond() const { return fused || cohesion > 0.0 || tension > 0.0; }
};

}  // namespace keyblock::contact
