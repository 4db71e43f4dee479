#pragma once
#include "scenario/scenario.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// Whether all histories of elements name one of the model. Throws InputError at the key.
void check_element_histories(const Scenario& scenario, const simulation::RunSetup& setup);

}  // namespace keyblock::scenario
