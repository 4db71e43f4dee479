#pragma once
#include <vector>

#include "cutting/block_system.h"
#include "scenario/scenario.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// Of every block: what it is made of. Keys of a [[block]] go before those of the last [[region]] that holds its centroid, and those before [rock].
std::vector<simulation::BlockProperties> properties_of(const Scenario& scenario,
                                                       const cutting::BlockSystem& system);

}  // namespace keyblock::scenario
