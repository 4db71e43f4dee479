#pragma once
#include <string>

#include "scenario/build.h"

namespace keyblock::scenario {

/// What the cutting of one realization came to, as JSON: fields as in the summary of a run, as far as they are known
/// without one (every excavation counts as opened), and for every joint set its geometry in the section and the intensity
/// of its traces in the domain (rockmass/intensity.h).
std::string cut_summary(const Scenario& scenario, int realization, const BlockModel& model,
                        const std::string& version);

}  // namespace keyblock::scenario
