#pragma once
#include "model/model.h"
#include "model/state.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// At the start of a stage: what was held until the end of the last one is held no more (StagedSupports::end_stage), and the supports that this
/// one installs come to life at the positions of the state, without force but pretension. What that stores is input of energy; else none is
/// added, and nothing moves. Of the stage only names are asked, so that any coupling may have supports of its own (dynamics::StagedSupports).
void install(const RunSetup& setup, const record::Stage& stage, const dynamics::Model& model,
             dynamics::State& state);

}  // namespace keyblock::simulation
