#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// The axes of [[study.shaking]]: a value is a record with its scales, record by record, and level by level within each. A record j of
/// intensity x_j comes to the level x by the factor (x/x_j)^{1/p}, where the intensity goes with the power p of the motion. Reads the records.
/// `warnings`, if given, receives factors beyond the limits. Throws InputError for those beyond twice the limits, and for records that have no
/// such intensity.
std::vector<VarySpec> shaking_axes(const Scenario& scenario, std::vector<std::string>* warnings);

}  // namespace keyblock::scenario
