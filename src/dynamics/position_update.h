#pragma once
#include <span>

#include "coupling/attempt.h"
#include "dynamics/predicted_motion.h"
#include "dynamics/step_rules.h"

namespace keyblock::dynamics {

/// Positions and velocities of the blocks at the end of a step (docs/theory.md, section "Pose update"). spin: rad, per block.
void move_blocks(const Attempt& attempt, std::span<const double> spin, const StepRules& rules, State& state);

/// Brings the surface to where the blocks are. State::moved and the paths of `motion` follow from how far its vertices went.
void place_surface(Model& model, State& state, PredictedMotion& motion, ThreadTeam& team);

/// J per thickness, Σ f·d: work of the loads, as they are at `time`, s, over a way d of the coefficients of all blocks.
double work_of_loads(const Model& model, double time, std::span<const double> way);

/// Sums the energy of springs to the ground anew, at `time`, s. What they gained, J per thickness.
double renew_support_energy(const Model& model, double time, State& state);

/// m, largest of State::moved. Throws RunError where that is not a number; time: s, at the end of the step.
double largest_move(const Model& model, const State& state, double time);

}  // namespace keyblock::dynamics
