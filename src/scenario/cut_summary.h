#pragma once
#include <string>
#include <vector>

#include "scenario/build.h"

namespace keyblock::scenario {

/// What the cutting of one realization came to, as JSON: fields as in the summary of a run, as far as they are known
/// without one (every excavation counts as opened), and for every joint set its geometry in the section and the intensity
/// of its traces in the domain (rockmass/intensity.h).
std::string cut_summary(const Scenario& scenario, int realization, const BlockModel& model,
                        const std::string& version);

/// What to say of slivers: where more than 1 % of the blocks that joints cut were merged; across which joints that run through, and how
/// high the teeth are that this left in them; which were left as the scenario's tolerances ask for it. The last blocks of
/// the system are the scenario's own, which were not cut.
std::vector<std::string> sliver_notes(const Scenario& scenario, const cutting::BlockSystem& system);

}  // namespace keyblock::scenario
