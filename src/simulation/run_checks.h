#pragma once
#include "record/record.h"
#include "simulation/checkpoint.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Why a run cannot go on. Each check throws a RunError that names the stage and the step, and repeats what is odd in the input.

/// Energies that are no finite numbers.
void check_energies(const RunSetup& setup, const RunState& now, const record::Energy& energy);

/// A state after a step in which a position is no finite number.
void check_state(const RunSetup& setup, const RunState& now);

/// A hundred steps in a row that did not converge. Each of them takes many times as long as others.
void check_converging(const RunSetup& setup, const RunState& now);

/// A stage that has ended without any step that converged. Single steps that do not converge leave a result, which can be judged by what
/// is out of balance; such a stage leaves none.
void check_solved(const RunSetup& setup, const RunState& now, const record::StageRecord& stage);

}  // namespace keyblock::simulation
