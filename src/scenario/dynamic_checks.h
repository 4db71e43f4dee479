#pragma once
#include <string>
#include <vector>

#include "core/error.h"
#include "scenario/scenario.h"
#include "simulation/setup.h"

/// What dynamic stages would do that nobody means.
namespace keyblock::scenario {

/// Rock with weight that a dynamic stage takes out over a compliant base: nothing carries the change, and the model rises.
std::vector<Diagnostic> dynamic_mistakes(const Scenario& scenario, const simulation::RunSetup& setup);

/// Motions that shake a closed box, loads that change after the end of the run, damping that waves do not have, springs that the rule of
/// time integration damps.
void add_dynamic_warnings(const Scenario& scenario, const simulation::RunSetup& setup,
                          std::vector<std::string>& warnings);

/// Pa, the largest stress of the waves of the motions that shake a frame: what their velocities v make in the rock, ρ c v. 0: none does.
double stress_left_out(const simulation::RunSetup& setup);

}  // namespace keyblock::scenario
