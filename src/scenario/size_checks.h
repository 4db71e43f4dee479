#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// What only the blocks show, added to `warnings`: limits of damage that no block reaches or that all pass, a seismic coefficient or a
/// tilt that pushes into the slope.
void add_size_warnings(const Scenario& scenario, const simulation::RunSetup& setup,
                       std::vector<std::string>& warnings);

/// 1: the ground falls to the right; -1: to the left; 0: neither, after all that stages excavate has been taken out.
int side_of_slope(const simulation::RunSetup& setup);

}  // namespace keyblock::scenario
