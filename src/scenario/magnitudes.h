#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// Where a value stands, for a warning: ` (line 14)`, ` (--set)`, or nothing where it is not in the file.
std::string place_text(const Scenario& scenario, const std::string& key);
std::string place_text(const SourcePosition& where);

/// Values far from what is usual for rock in SI units (usual.h), added to `warnings`. None where the units are others.
void add_magnitude_warnings(const Scenario& scenario, std::vector<std::string>& warnings);
/// Whether they tell of the value of a key, or of one below it: what follows from that value is not told again.
bool is_unusual(const Scenario& scenario, const std::string& key);

}  // namespace keyblock::scenario
