#pragma once
#include "dynamics/step.h"
#include "simulation/damage.h"
#include "simulation/setup.h"
#include "simulation/staged_opening.h"

namespace keyblock::simulation {

/// Takes the blocks of the excavations that a stage opens out of the model and of the state. Where they are opened in parts, what they did
/// to the others is kept. The first excavation is where the gauge of damage starts. Energy that goes with the blocks is negative input.
void excavate(const RunSetup& setup, const record::Stage& stage, dynamics::Model& model,
              dynamics::State& state, dynamics::Stepper& stepper, DamageGauge& gauge,
              const StagedOpening& opening);

}  // namespace keyblock::simulation
