#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"
#include "simulation/rock_sample.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// What [boundary] says, without the rock beside the model. Nothing without [boundary], or with a frame.
std::optional<simulation::Boundary> boundary_of(const Scenario& scenario);

/// Puts the rock beside the model into setup.boundary: the layers that [boundary] gives, or those of the blocks at the sides, and the
/// half-space below. Returns the joints of the model. Throws InputError where there is no rock to take it from.
std::vector<simulation::JointPiece> place_far_rock(const Scenario& scenario, simulation::RunSetup& setup);

/// Puts the planes into setup.boundary that slip beside the model as well, under the motions of the setup. What joints would slip there and
/// cannot is added to `warnings`.
void place_far_planes(const Scenario& scenario, simulation::RunSetup& setup,
                      std::span<const simulation::JointPiece> pieces, std::vector<std::string>& warnings);

/// What is said of the rock around the model in reports and by `check`.
std::vector<std::pair<std::string, std::string>> boundary_facts(const simulation::RunSetup& setup);

/// What seems wrong with [boundary] and what acts on it.
void add_boundary_warnings(const Scenario& scenario, const simulation::RunSetup& setup,
                           std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
