#pragma once
#include <string>

#include "study/run_result.h"

namespace keyblock::study {

/// A RunResult as JSON: runs/KEY/run.json, or failed.json. Every number to its last bit; the map as pairs of a status and
/// how many cells in a row have it. `input` tells what was run (Plan::input with the version of the program). The last
/// member is a checksum of all before it. Fields: docs/studies.md.
std::string run_json(const RunResult& run, const std::string& input);

/// Throws InputError, without a file name, for text that is truncated, changed, of another format or of other input.
RunResult read_run_json(const std::string& text, const std::string& input);

}  // namespace keyblock::study
