#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "contact/candidates.h"
#include "contact/joint_law.h"
#include "core/parallel.h"
#include "geometry/vec2.h"

namespace keyblock::contact {

/// By what a joint breaks: more tension than it bears; slip; or, as it has no tensile strength any more, the opening that takes its cohesion.
enum class BreakMode : std::uint8_t { none = 0, tension = 1, shear = 2, opening = 3 };

/// Direction of an edge from its outward normal.
inline Vec2 tangent_of(Vec2 normal) {
  return {-normal.y, normal.x};
}

/// A contact of this step: vertex V of block a against edge AB of block b, linear in the displacements of both.
///
///     gap  g = n · (V − P),     g(D) = gap + n · r,     r = D_a(V) − D_b(P),   P = (1 − s) A + s B
///     slip u(D) = shear + t · r
///
/// n is the outward unit normal of the edge, t its direction (A to B). Where AB is a piece of a divided edge, P is on the curve through
/// all vertices of the whole edge (edge_curve.h).
struct Contact {
  int candidate = 0;  ///< of the list
  int block_a = 0, block_b = 0;
  int vertex = 0, edge = 0;
  Vec2 normal;
  double position = 0.0;  ///< s, 0 at A, 1 at B; a little outside near the ends
  double gap = 0.0;       ///< m, of the geometry
  /// m of joint that belongs to the contact: half of what each facing pair of edges shares, at either end. Where two corners meet in one
  /// contact, the contact has the share of both corners.
  double length = 0.0;
  double depth = 0.0;  ///< m, −(gap + offset): what the normal spring sees at the start of the step
  double normal_stiffness = 0.0, shear_stiffness = 0.0;  ///< N/m per thickness
  double friction_coefficient = 0.0;
  double cohesion = 0.0, tension = 0.0;  ///< N per thickness, of a bond
  StrengthLoss loss;                     ///< of its joint, by slip from the start of the step on
  bool fused = false;
  bool is_ductile = false;  ///< a bond that holds on when it slips
  bool at_corner = false;   ///< it stands for two corners that meet
  /// By what its bond broke in the step, or what it loses by slip or opening was lost.
  BreakMode broke = BreakMode::none;
  bool was_in_face = false;  ///< Memory::in_face of the last step
  Memory memory;             ///< at the start of the step; no bond any more where the bond breaks in the step

  [[nodiscard]] Vec2 tangent() const { return tangent_of(normal); }
  /// Whether its joint keeps some cohesion when it slips.
  [[nodiscard]] bool keeps_cohesion() const { return memory.bonded && memory.piece >= 0; }
  /// Whether it is a bond that ends when it opens, and not by its tensile strength.
  [[nodiscard]] bool is_lost_by_opening() const {
    return memory.bonded && !fused && (memory.piece >= 0 || tension == 0.0);
  }
  /// It bears no tension from now on.
  void tear() {
    tension = 0.0;
    memory.is_torn = true;
  }
  /// It has residual strength from now on, and is a bond that holds on.
  void wear_out() {
    friction_coefficient -= loss.friction;
    cohesion -= loss.cohesion;
    tension = 0.0;
    loss = {};
    is_ductile = true;
    memory.worn = JointLaw::worn_out;
  }
};

/// Takes what the contacts of a step remember over into the list. Candidates that were no contacts remember nothing.
void keep_memory(std::span<const Contact> contacts, CandidateList& candidates, ThreadTeam& team);

}  // namespace keyblock::contact
