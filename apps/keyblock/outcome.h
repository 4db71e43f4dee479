#pragma once
#include <string>

#include "simulation/record.h"

namespace keyblock::app {

/// How a run ended, for people: what was computed, a table with a row per stage, and what to be wary of.
std::string outcome_text(const simulation::RunRecord& run, std::size_t block_count);

/// What the time of a run was spent on, the largest part first.
std::string profile_text(const simulation::RunRecord& run);

}  // namespace keyblock::app
