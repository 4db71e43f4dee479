#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "coupling/attempt.h"
#include "model/integrator.h"

namespace keyblock::dynamics {

/// Which rule of time integration each block takes in a step: the rule of the scenario, Shi's where that needs an acceleration that is not
/// known, and Shi's with θ = restitution where a block strikes another one.
///
/// An impact that the step does not resolve: the blocks come to rest against each other within it, D ≈ 0, and the rule
/// v ← (1+θ)D/Δt − θv would send them back with θ times the speed they came with. That is less where they meet later in the step, φ = gap/(v Δt)
/// of it: (θ − (1+θ) φ) v, and none where φ is large.
///
/// SolverOptions::keeps_restitution: they part with e v for any φ. θ = (e + φ)/(1 − φ) does so up to φ = (1 − e)/2, where it is 1. Beyond, they
/// meet that much earlier, before the gap is closed (held_off). θ is the smallest of all impacts of blocks that strike each other.
class StepRules {
 public:
  explicit StepRules(std::size_t blocks) : rule_(blocks), in_impact_(blocks, 0), struck_(blocks, 0) {}

  /// Before the first attempt at a step: no block strikes another one.
  void choose(const Model& model, const State& state, bool is_static);
  /// Lowers θ of blocks that are pressed upon while they approach faster than the speed of an impact. Whether there is a new one.
  /// speed: m/s, per block, of its fastest vertex at the start of the step.
  bool meet_impacts(const Attempt& attempt, std::span<const double> speed);

  [[nodiscard]] std::span<const Integrator> rule() const { return rule_; }
  [[nodiscard]] bool is_in_impact(std::size_t block) const { return in_impact_[block] != 0; }
  /// Per block, whether it strikes another one so that they part as the restitution says.
  [[nodiscard]] std::span<const std::uint8_t> struck() const { return struck_; }
  /// m/s, approach from which on blocks strike each other.
  [[nodiscard]] double impact_speed() const { return impact_speed_; }

 private:
  void slow(const Model& model, int block, double theta, bool strikes);
  void share_smallest(const Attempt& attempt);

  std::vector<Integrator> rule_;         ///< per block
  std::vector<std::uint8_t> in_impact_;  ///< per block
  bool found_ = false;                   ///< a block that was not in impact before
  std::vector<std::uint8_t> struck_;     ///< per block
  double impact_speed_ = 0.0;            ///< m/s
  std::vector<std::size_t> fast_;        ///< scratch: contacts that may be fast enough
};

}  // namespace keyblock::dynamics
