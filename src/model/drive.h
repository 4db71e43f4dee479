#pragma once
#include <cstdint>
#include <span>

#include "contact/contact.h"
#include "geometry/vec2.h"
#include "model/integrator.h"

namespace keyblock::dynamics {

/// What drives one step.
struct Drive {
  double step = 0.0;         ///< s, Δt
  double end_time = 0.0;     ///< s, at which loads and supports are taken
  Vec2 ground_acceleration;  ///< m/s², that the step is solved with: the mean over it, or that at its end
  Vec2 ground_before;        ///< m/s², at its start
  double owed_share = 0.0;   ///< length of the last dynamic step over that of this one; static: 0
  bool wears_joints = true;  ///< slip in the step counts for the strength of joints
  bool is_static = false;    ///< velocities are dropped; inertia only keeps the step small
  /// Static only: factor on the inertia of each block.
  std::span<const double> inertia_scale;
  /// Static only: the step is tried, to see how far blocks go. Π is bounded from below whatever its inertia.
  bool is_trial = false;
  std::span<const Integrator> rule;  ///< of each block
  /// Of each block, whether it strikes another one in the step; and m/s, approach from which on a contact of two such blocks is an impact.
  std::span<const std::uint8_t> in_impact;
  double impact_speed = 0.0;
  /// m, of each block: what a fixed block is moved by in the step; empty when none is.
  std::span<const Vec2> prescribed;
  /// m, of each contact: by how much more than linear in D its vertex is from the point of the edge at the end of the step, as its blocks
  /// turn, across the edge (x) and, of a bond, along it (y); empty: by nothing.
  std::span<const Vec2> rotation;

  /// s, at the start of the step.
  [[nodiscard]] double start_time() const { return is_static ? end_time : end_time - step; }
  /// Integrator::end_share_of_work of a block.
  [[nodiscard]] double end_share_of_work(int block) const {
    return rule[static_cast<std::size_t>(block)].end_share_of_work();
  }
  /// Of what acts between two blocks, of which one may be fixed: by the rule of one that moves.
  [[nodiscard]] double end_share_of_work(const contact::Contact& c, bool moves_a) const {
    return end_share_of_work(moves_a ? c.block_a : c.block_b);
  }

  /// Whether there is a known part of the relative displacement of contacts.
  [[nodiscard]] bool moves_contacts() const { return !prescribed.empty() || !rotation.empty(); }
  /// m, what block a is moved by less what block b is.
  [[nodiscard]] Vec2 prescribed_between(const contact::Contact& c) const {
    return prescribed.empty() ? Vec2{}
                              : prescribed[static_cast<std::size_t>(c.block_a)] -
                                    prescribed[static_cast<std::size_t>(c.block_b)];
  }
};

}  // namespace keyblock::dynamics
