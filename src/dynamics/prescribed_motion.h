#pragma once
#include <span>

#include "coupling/step_problem.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// m, per block: what a step moves fixed blocks by, from where they are to where they are to be at its end, s.
void prescribe(const Model& model, const State& state, double end_time, std::span<Vec2> prescribed);
/// Takes the motion of a step over into the state.
void move_prescribed(const Model& model, const Drive& drive, State& state);

}  // namespace keyblock::dynamics
