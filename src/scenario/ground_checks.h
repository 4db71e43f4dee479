#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// A frame that lies on the ground beside a cut, where rock would rise or topple.
void add_ground_warnings(const Scenario& scenario, std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
