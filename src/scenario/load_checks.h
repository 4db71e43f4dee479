#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// N per thickness, of a load with the factor on all loads and the largest of its own over time.
Vec2 resultant(const Scenario& scenario, const loading::Load& load);

/// Whether a key is one of a load that is told to be far too weak for its block.
bool is_weak_load(const Scenario& scenario, const std::string& key);

/// Loads that are far too weak for their block or pull at its face, and prescribed displacements that go far, added to `warnings`.
void add_load_warnings(const Scenario& scenario, std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
