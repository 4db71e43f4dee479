#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// Strengths of joints that do not do what they seem to, added to `warnings`: tension that no joint reaches, residual strength to which nothing
/// falls or that a set inherits, cohesion that a factor of safety loses contact by contact.
void add_strength_warnings(const Scenario& scenario, std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
