#pragma once
#include <string>
#include <utility>
#include <vector>

#include "scenario/build.h"
#include "scenario/scenario.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// Strength and stiffness of joints by set and map, and by trace where strengths are drawn or a trace map has them, divided by their
/// strength_factor. A residual strength above the peak of its trace is that of the peak.
simulation::JointTable joint_table(const Scenario& scenario, const BlockModel& model);

/// Strengths that were drawn, or that maps have: names and values.
std::vector<std::pair<std::string, std::string>> strength_facts(const simulation::JointTable& joints);

/// Whether anything beside the geometry of joints differs from realization to realization.
bool has_random_strengths(const Scenario& scenario);
/// Whether a strength is drawn once in each realization.
bool has_strengths_of_realizations(const Scenario& scenario);

}  // namespace keyblock::scenario
