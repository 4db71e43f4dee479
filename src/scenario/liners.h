#pragma once
#include <string>
#include <vector>

#include "geometry/polygon.h"
#include "scenario/scenario.h"
#include "simulation/setup.h"

/// Liners of a scenario.
namespace keyblock::scenario {

/// Every liner of the scenario, along its wall. outlines: of the excavations. Coordinates are those of the outlines and the scenario.
std::vector<loading::Liner> liners_of(const Scenario& scenario, const std::vector<Ring>& outlines);

/// Throws what only the cut blocks show to be wrong, with the place in the scenario: a wall that has no rock, or that has it on both sides. Turns polylines so
/// that they have the rock on the right. Adds what seems odd.
void check_liners(const Scenario& scenario, simulation::RunSetup& setup, std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
