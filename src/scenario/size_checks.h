#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// What only the blocks show, added to `warnings`: limits of damage that no block reaches or that all pass, a seismic coefficient or a
/// tilt that pushes into the slope.
void add_size_warnings(const Scenario& scenario, const simulation::RunSetup& setup,
                       std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
