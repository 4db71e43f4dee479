#pragma once
#include <span>
#include <string>
#include <string_view>

#include "record/record.h"

namespace keyblock::app {

/// How a run ended, for people: what was computed, a table with a row per stage, and what to be wary of. scenario and openings: file and names,
/// for the command that finds the support pressure.
std::string outcome_text(const record::RunRecord& run, std::size_t block_count,
                         std::string_view scenario = "SCENARIO.toml",
                         std::span<const std::string> openings = {});

/// What the time of a run was spent on, the largest part first.
std::string profile_text(const record::RunRecord& run);

}  // namespace keyblock::app
