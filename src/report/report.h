#pragma once
#include <filesystem>
#include <string>

#include "results/run_data.h"

namespace keyblock::report {

/// The report of one run: a single HTML page that carries its program, its styles and its data, and asks
/// nothing of the network. Depends on `run` alone: the same run gives the same bytes.
///
/// To keep the page small, frames are thinned to at most 300 (those at the start and end of each stage stay),
/// contact snapshots to 60, and histories to about 4,000 points with their extremes kept; see page_data.h.
std::string render_report(const results::RunData& run);

/// Writes render_report(run) to `directory`/report.html. Throws RunError when it cannot be written.
void write_report(const results::RunData& run, const std::filesystem::path& directory);

}  // namespace keyblock::report
