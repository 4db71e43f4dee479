#pragma once
#include <span>
#include <vector>

#include "contact/tolerances.h"
#include "coupling/attempt.h"

namespace keyblock::dynamics {

/// The rotation correction of a step: what contacts miss of the gap at its end, as a step is linear in D and blocks turn.
///
/// Vertices of a block that turns by w leave the straight path by ½ w² r, and the line of an edge that turns moves away from a vertex that
/// slides along it. With g the gap at the start, r what the two sides are displaced by, and g′ the gap once blocks are where the pose
/// update takes them,
///
///     δ = g′ − (g + n·r)           across the edge (x), and along it (y, of bonds only)
///
/// δ matters where a contact presses, or comes to press by δ only. There are two measures: δ itself, and the work N δ of the normal force,
/// which is done on no block. An attempt in which δ is too large is made again with g + δ in place of g, until δ is what it was made with.
/// Where blocks turn so far that forces have other directions at the end, the step is too long (docs/theory.md, section 6, "Blocks that turn"). So it
/// is where a block turns that springs hold to the ground, whatever touches it.
class RotationCorrection {
 public:
  RotationCorrection(const Model& model, const contact::Tolerances& tolerances);

  /// Before the first attempt at a step, and where contacts are found anew: δ = 0.
  void forget() { known_.clear(); }
  /// Turns of the blocks in an attempt, from its increment.
  void measure_spin(const Attempt& attempt);
  /// Verdict::accepted, rotated, or rotated_too_far.
  Verdict check(const Attempt& attempt);
  /// The next attempt is made with what the last check() found.
  void take_over() { known_.swap(found_); }

  /// m, δ per contact that the attempt was made with; empty: 0.
  [[nodiscard]] std::span<const Vec2> known() const { return known_; }
  /// rad, per block.
  [[nodiscard]] std::span<const double> spin() const { return spin_; }
  /// m, where a vertex of the surface comes to be: the pose update of its block.
  [[nodiscard]] Vec2 at_end(const Attempt& attempt, std::size_t vertex) const;

  /// Once blocks are where they come to be. Bonds that hold while their blocks turn: what the step missed along the edge is shear as any
  /// other. Else they would creep, always the same way, and tear what is bonded around them. J per thickness that springs gain by it.
  double keep_shear(const Attempt& attempt, std::span<contact::Memory> memory);

 private:
  [[nodiscard]] bool turns_held_too_far() const;
  [[nodiscard]] double carried(const Attempt& attempt) const;
  [[nodiscard]] double tolerated_work(const Attempt& attempt, double farthest) const;
  [[nodiscard]] double tolerated(double work, double force, double stiffness) const;
  Verdict check_contact(const Attempt& attempt, std::size_t c, double work);

  double tolerance_;               ///< m, largest change of δ
  double largest_radius_ = 0.0;    ///< m, of the blocks that move
  double weight_ = 0.0;            ///< N per thickness, of a mean block; 0: there is no gravity
  std::vector<std::size_t> held_;  ///< blocks that springs hold to the ground
  std::vector<double> spin_;
  std::vector<Vec2> known_, found_;
  std::vector<double> gained_;  ///< J per thickness, per contact. Scratch
};

}  // namespace keyblock::dynamics
