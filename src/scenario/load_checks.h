#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// N per thickness, of a load with the factor on all loads and the largest of its own over time.
Vec2 resultant(const Scenario& scenario, const loading::Load& load);

/// Loads that are far too weak for their block or pull at its face, and prescribed displacements that go far, added to `warnings`.
void add_load_warnings(const Scenario& scenario, std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
