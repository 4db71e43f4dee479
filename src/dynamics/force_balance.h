#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "coupling/step_problem.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// The static balance of every block at a position: contacts, internal forces, loads and supports there. Shear forces are cut off at the
/// Coulomb bounds of the normal forces there. With g = ∇Π(0) of a static step at that position,
///
///     ratio = |g_block| / scale
///
/// (all coefficients; a force F at the centroid is F/√A). The scale is the weight ρ√A g of the block, or the largest generalized force of
/// a load on it where this is more. Without gravity, a block that only contacts load is measured by its contacts: the sum of their forces
/// over √A, at least 10⁻⁴ of the largest of all blocks, at most what the step measures it by (BlockTerms::weight).
class ForceBalance {
 public:
  struct OfBlock {
    double ratio = 0.0;      ///< out of balance, over the scale
    double predicted = 0.0;  ///< what the inertia of the step left: the ratio, if the step were linear
    double rounding =
        0.0;               ///< what of the ratio may be rounding: of strains near 1 and of depths of contacts
    double falling = 0.0;  ///< the same along gravity: share of the weight that nothing carried in the step
  };
  /// Whether a block balances to a tolerance, as far as numbers have digits.
  [[nodiscard]] bool balances(std::size_t block, double tolerance) const {
    const OfBlock& of = of_[block];
    return of.ratio <= tolerance || (of.ratio <= of.rounding && of.predicted <= tolerance);
  }
  [[nodiscard]] const OfBlock& operator[](std::size_t block) const { return of_[block]; }
  /// N/kg: the largest acceleration that the forces out of balance would give a block, of those for which counts(block).
  template <typename Counts>
  [[nodiscard]] double largest_acceleration(const Counts& counts) const {
    double most = 0.0;
    for (std::size_t b = 0; b < of_.size(); ++b) {
      if (counts(b)) most = std::max(most, of_[b].ratio * scale_[b] / body_force_[b]);
    }
    return most;
  }

  /// Of bodies that are no blocks: the largest force that the inertia of the step left, over the weight of the block that they are in. Blocks may be
  /// at rest long before a liner on them is.
  [[nodiscard]] double left_of_lines() const { return left_of_lines_; }

  /// Before the position changes: what the inertia of the step leaves. problem: of the step; d: its increment.
  void predict(const Model& model, const StepProblem& problem, std::span<const double> d);
  /// Sets the bounds of the springs of a problem to those of the normal forces at D = 0.
  static void take_bounds(StepProblem& problem);
  /// problem: of a static step from the position, at D = 0, with these bounds.
  void measure(const Model& model, const StepProblem& problem);

 private:
  void find_scales(const Model& model, const StepProblem& problem);
  void find_rounding(const Model& model, const StepProblem& problem);

  std::vector<OfBlock> of_;
  std::vector<double> scale_, body_force_;  ///< N and kg, of coefficients: over √A
  double left_of_lines_ = 0.0;
  std::vector<double> left_, left_down_;  ///< N over √A: what the inertia left, all of it and along gravity
  std::vector<double> zero_, gradient_, force_;  ///< scratch
  std::vector<Vec2> at_vertices_;                ///< scratch
};

}  // namespace keyblock::dynamics
