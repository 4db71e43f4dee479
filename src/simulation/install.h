#pragma once
#include "model/model.h"
#include "model/state.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// Brings the supports that a stage installs to life, without force at the positions of the state: nothing moves by that, and no energy is
/// added. Of the stage only names are asked, so that any coupling may have supports of its own (dynamics::StagedSupports).
void install(const RunSetup& setup, const record::Stage& stage, const dynamics::Model& model,
             dynamics::State& state);

}  // namespace keyblock::simulation
