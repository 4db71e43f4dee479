#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "solve/bound_step.h"
#include "solve/corrections.h"
#include "solve/step_system.h"

namespace keyblock::dynamics {

/// Accelerator: bounds of friction that follow the normal forces of their contacts while a low-rank update finds these. They are the few
/// bounds that new normal forces change most; all other bounds stay frozen until the next update (LawUpdates::update_bounds).
///
/// Contacts that slip and stick in turn hand their bounds to and fro: in a problem of a few hundred unknowns, not of all blocks.
class FollowedBounds {
 public:
  /// What an update of bounds changes of the shear force of a contact, squared.
  struct Change {
    std::size_t contact;
    double squared;
  };
  /// At the start of a step: no bound is followed.
  void reset() { contacts_.clear(); }
  /// Follows those that change most besides those that are followed, until the others change little.
  void choose(std::vector<Change>& changes);
  [[nodiscard]] std::span<const std::size_t> contacts() const { return contacts_; }

  /// Where the normal and the shear spring of a contact are among those of the corrections.
  struct Springs {
    std::size_t normal, shear;
  };
  /// From the forces that the corrections found for these laws, until bounds and normal forces agree. `springs`: of each contact. False when
  /// forces are not found; laws then are of no use.
  [[nodiscard]] bool settle(const StepSystem& system, std::span<const Springs> springs,
                            std::span<Corrections::Law> laws, Corrections& corrections);

 private:
  [[nodiscard]] double find_missing(const StepSystem& system, std::span<const Springs> springs,
                                    std::span<const Corrections::Law> laws, const Corrections& corrections);
  void take_steps(std::span<const Springs> springs, std::span<Corrections::Law> laws, double damping);

  std::vector<std::size_t> contacts_;
  std::vector<double> missing_;   ///< N per thickness, of their bounds; scratch
  std::vector<BoundStep> steps_;  ///< the last of each; scratch
};

}  // namespace keyblock::dynamics
