#pragma once
#include <vector>

#include "dynamics/step.h"
#include "record/record.h"
#include "simulation/moving_blocks.h"

namespace keyblock::simulation {

/// Brings a block system to static equilibrium (docs/theory.md, section 7).
///
/// Each static step solves for equilibrium with an inertia (1+θ)M/Δt² that only keeps the step small. Equilibrium is measured by the forces
/// at the position that the step reached (dynamics::ForceBalance). The pseudo time step grows while the solution comes quickly. A block
/// that would go farther than the creep limit in a step gets more inertia, alone. The limit falls where steps are too long for their
/// balance to be what was predicted, and rises where the prediction holds.
///
/// Where the predicted balance does not get better, a trial with little inertia tells what moves without bound from what rests. Blocks that
/// are moving (MovingBlocks) are held where they were named, and the rest goes on to equilibrium.
class Settler {
 public:
  Settler(const dynamics::Model& model, double time_step, double tolerance);

  /// One static step; true when equilibrium is reached.
  bool step(dynamics::Stepper& stepper, dynamics::State& state, dynamics::StepReport& report);
  /// The system has changed: what was in balance must show it again.
  void begin_again();

  /// Largest balance over blocks that are not moving.
  [[nodiscard]] double worst_ratio() const { return memory_.worst_ratio; }
  /// Per block.
  [[nodiscard]] std::vector<bool> which_move() const;
  /// Blocks that are moving. stepper: after the last step, for the contacts that make groups of them.
  [[nodiscard]] std::vector<record::MovingBlock> moving(const dynamics::Stepper& stepper) const;
  /// m, the largest way of a block that is in equilibrium, while it was not.
  [[nodiscard]] double astray() const { return moving_.astray(); }
  /// Share of the way to equilibrium, estimated from the logarithm of the worst balance, for a progress bar.
  [[nodiscard]] double progress() const;

  /// Everything that changes, for checkpoints.
  struct Memory {
    double time_step = 0.0;  ///< s
    double creep = 0.0;      ///< m, that a block may go in a step
    int steps = 0, quiet_steps = 0;
    double first_ratio = 0.0, worst_ratio = 0.0;
    double best_predicted = 0.0;        ///< by half of which the predicted balance has to fall …
    int since_best = 0;                 ///< … within some steps
    int wait = 0;                       ///< so many, before a trial
    double trial_acceleration = 0.0;    ///< N/kg: largest of a block, as the last step left it
    std::vector<double> inertia_scale;  ///< per block, ≥ 1
    MovingBlocks::Memory blocks;
  };
  [[nodiscard]] Memory memory();
  void restore(Memory memory);

 private:
  bool try_far(dynamics::Stepper& stepper, dynamics::State& state, dynamics::StepReport& report);
  void control(const dynamics::StepReport& report, double worst_predicted);
  /// Inertia scale of a moving block in a step of this length, s.
  [[nodiscard]] double held_scale(double step) const;
  void control_inertia(std::span<const double> moved);

  const dynamics::Model& model_;
  double longest_step_, tolerance_, step_tolerance_;
  std::vector<bool> is_held_;  ///< per block: on supports
  MovingBlocks moving_;
  Memory memory_;
};

}  // namespace keyblock::simulation
