#pragma once
#include <vector>

#include "dynamics/step.h"
#include "simulation/record.h"

namespace keyblock::simulation {

/// Brings a block system to static equilibrium.
///
/// Each static step solves for equilibrium with an inertia (1+θ)M/Δt² that only keeps the step small. A block's balance is
/// its force out of equilibrium over its weight. The pseudo time step grows while the solution comes quickly. A block that
/// would move more than a small distance in a step gets more inertia, alone: loose blocks creep while the rock around
/// them comes to rest. A block that has crept further than `travel_limit` out of balance, and come no nearer to it by a tenth, is called
/// moving: what bends or closes until it carries its load comes nearer as it goes. The system is in equilibrium when every block that is not moving has been within the tolerance for some steps. A block on supports
/// cannot fall: it is never called moving, however far its load bends it.
class Settler {
 public:
  Settler(const dynamics::Model& model, double time_step, double tolerance);

  /// One static step; true when equilibrium is reached.
  bool step(dynamics::Stepper& stepper, dynamics::State& state, dynamics::StepReport& report);

  /// Largest balance over blocks that are not moving.
  [[nodiscard]] double worst_ratio() const { return worst_ratio_; }
  [[nodiscard]] std::vector<MovingBlock> moving() const;
  /// Share of the way to equilibrium, estimated from the logarithm of the worst balance, for a progress bar.
  [[nodiscard]] double progress() const;

  /// Everything that changes, for checkpoints.
  struct Memory {
    double time_step = 0.0;
    int quiet_steps = 0;
    double first_ratio = 0.0;
    std::vector<double> inertia_scale;  ///< per block, ≥ 1
    std::vector<double> travel;   ///< m, per block, since it was in balance, or came nearer to it by a tenth
    std::vector<double> nearest;  ///< per block, best balance since it was in balance
    std::vector<double> carried;  ///< per block, share of the weight that contacts carry
  };
  [[nodiscard]] Memory& memory() { return memory_; }

 private:
  const dynamics::Model& model_;
  double longest_step_, tolerance_;
  std::vector<double> creep_limit_, travel_limit_;  ///< m, per block
  double worst_ratio_ = 0.0;
  Memory memory_;
};

}  // namespace keyblock::simulation
