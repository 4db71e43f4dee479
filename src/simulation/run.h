#pragma once
#include <atomic>
#include <filesystem>

#include "simulation/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

struct RunOptions {
  int threads = 1;
  /// Where checkpoints are kept; empty: none are written.
  std::filesystem::path directory;
  /// Go on from the checkpoint in `directory`. The end is the same, bit for bit, as without the interruption.
  bool resume = false;
  double progress_interval = 0.2;  ///< s of wall time between progress reports
  /// Set by a signal handler: the run ends within the step at hand, with everything so far reported.
  const std::atomic<bool>* stop = nullptr;
};

/// Runs all stages of `setup`. Throws InputError for a model that cannot be built, RunError when a step cannot be
/// solved; the observer has then received everything up to that step, and end().
RunRecord run(const RunSetup& setup, const RunOptions& options, RunObserver& observer);

}  // namespace keyblock::simulation
