#pragma once
#include <filesystem>
#include <vector>

#include "simulation/record.h"

namespace keyblock::results {

/// A whole result file in memory.
struct RunData {
  simulation::ModelRecord model;
  /// Of a run that was killed: the stages that had ended, the one it was killed in (as far as it is known, marked as
  /// interrupted), and the sums that follow from both.
  simulation::RunRecord run;
  std::vector<simulation::Frame> frames;
  std::vector<simulation::ContactFrame> contacts;
  std::vector<simulation::HistoryRow> histories;
  std::vector<simulation::StepRow> steps;
};

/// Of every block, at the end of what was recorded.
std::vector<int> last_orders(const RunData& run);

/// Reads DIR/result.h5. Throws InputError when there is none, or when it is truncated or of another format.
RunData read_run(const std::filesystem::path& directory);

/// Whether the run has come to its end, so that all it leaves is in DIR but the report. Throws InputError as read_run does.
bool has_ended(const std::filesystem::path& directory);

/// Its histories alone.
std::vector<simulation::HistoryRow> read_histories(const std::filesystem::path& directory);

}  // namespace keyblock::results
