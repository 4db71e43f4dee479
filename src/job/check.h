#pragma once
#include <string>
#include <vector>

#include "scenario/build.h"
#include "scenario/scenario.h"

namespace keyblock::job {

/// What can be known of a run before it starts, from a scenario and its blocks. Returns warnings. Throws InputError with all mistakes, and
/// RunError where the model cannot be built. A scenario without stages can still be cut.
std::vector<std::string> check(const scenario::Scenario& scenario, const scenario::BlockModel& blocks,
                               int realization);

}  // namespace keyblock::job
