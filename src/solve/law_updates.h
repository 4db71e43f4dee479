#pragma once
#include <vector>

#include "solve/bound_step.h"
#include "solve/iterate.h"

namespace keyblock::dynamics {

/// What a solution does to the laws of its springs, between two minimizations: bounds of friction, bonds, contacts that turn
/// round. Each function changes springs, and the gradient with them, and says whether it changed any.
class LawUpdates {
 public:
  /// At the start of a step.
  void begin();

  /// A spring that holds from where the velocity ends (ContactCoupling) would turn the friction of a contact that does not rest
  /// there always too late or too early. Such contacts get springs that turn where the way of the step does, if that changes the shear
  /// forces by more than `tolerance` of the bounds (L2 over all contacts).
  bool reverse_sliding(const StepSystem& system, Iterate& iterate, double tolerance);
  /// Bonds whose shear force passes what they bear now, or what the step began with, where these differ, get what they bear now: a bound
  /// of before the load came would have them break that hold.
  bool renew_bonds(const StepSystem& system, Iterate& iterate);
  /// Bonds whose strength is exceeded lose it for good, in the memory of their contacts too: all of it, or where their joint keeps cohesion
  /// (Contact::keeps_cohesion) the tension that is exceeded, or what the joint loses when it slips.
  bool break_bonds(const StepSystem& system, Iterate& iterate);
  /// What other couplings say of their rows (Coupling::change_laws): of their events those with the largest excess, few at once; where there are
  /// none, limits that go with other forces, a few times in a step.
  bool change_couplings(const StepSystem& system, Iterate& iterate);
  /// Coulomb bounds of the normal forces at hand, if that changes the shear forces by more than `tolerance` of the bounds (L2).
  bool update_bounds(const StepSystem& system, Iterate& iterate, double tolerance);

 private:
  void sum_bounds(const StepSystem& system);
  [[nodiscard]] bool reverses(const StepSystem& system, std::size_t c) const;

  // Contacts that turn round.
  std::vector<double> sliding_bound_;  ///< N per thickness, per block; scratch
  std::vector<std::size_t> reversed_;  ///< contacts; scratch

  std::vector<LawChange> changes_;  ///< scratch
  int limit_updates_ = 0;           ///< in this step, of limits that go with other forces

  // Bounds.
  struct KnownStep {
    BoundStep step;
    double bound = 0.0;  ///< N per thickness, what it led to
  };
  std::vector<KnownStep>
      bound_steps_;             ///< per contact, of the last update in this step; empty before the first
  int bound_updates_ = 0;       ///< in this step
  double bound_error_ = 0.0;    ///< of the last of them, over all bounds
  double bound_damping_ = 1.0;  ///< share of its way that each contact goes
};

}  // namespace keyblock::dynamics
