#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// Waters that reach nothing, or stand much too high; walls whose drainage is taken for granted; keys of water without any.
void add_water_warnings(const Scenario& scenario, std::vector<std::string>& warnings);

/// The waters of a scenario in coordinates from `origin` on.
std::vector<simulation::Water> waters_of(const Scenario& scenario, Vec2 origin);

}  // namespace keyblock::scenario
