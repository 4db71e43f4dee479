#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "scenario/build.h"

namespace keyblock::scenario {

/// What the cutting of one realization came to, as JSON: fields as in the summary of a run, as far as they are known
/// without one (every excavation counts as opened), and for every joint set its geometry in the section and the intensity
/// of its traces in the domain (rockmass/intensity.h).
std::string cut_summary(const Scenario& scenario, int realization, const BlockModel& model,
                        const std::string& version);

/// What to say where more than 1 % of the blocks that joints cut were merged as slivers; the last `explicit_blocks` of the
/// system were not cut.
std::optional<std::string> sliver_note(const cutting::BlockSystem& system, std::size_t explicit_blocks);

}  // namespace keyblock::scenario
