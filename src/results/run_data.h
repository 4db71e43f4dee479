#pragma once
#include <filesystem>
#include <vector>

#include "simulation/record.h"

namespace keyblock::results {

/// A whole result file in memory.
struct RunData {
  simulation::ModelRecord model;
  simulation::RunRecord run;  ///< complete up to the last stage that ended, when the run was interrupted
  std::vector<simulation::Frame> frames;
  std::vector<simulation::ContactFrame> contacts;
  std::vector<simulation::HistoryRow> histories;
  std::vector<simulation::StepRow> steps;
};

/// Reads DIR/result.h5. Throws InputError when there is none, or when it is truncated or of another format.
RunData read_run(const std::filesystem::path& directory);

}  // namespace keyblock::results
