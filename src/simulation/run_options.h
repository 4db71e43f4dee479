#pragma once
#include <atomic>
#include <filesystem>
#include <functional>

namespace keyblock::dynamics {
struct StepReport;
}

namespace keyblock::simulation {

class Runner;

struct RunOptions {
  int threads = 1;
  /// Where checkpoints are kept; empty: none are written.
  std::filesystem::path directory;
  /// Go on from the checkpoint in `directory`. The end is the same, bit for bit, as without the interruption.
  bool resume = false;
  double progress_interval = 0.2;  ///< s of wall time between progress reports
  /// Set by a signal handler: the run ends within the step at hand, with everything so far reported.
  const std::atomic<bool>* stop = nullptr;
  /// Called after every step, once its records are with the observer, and before a checkpoint. It may look at the run, change it
  /// (Runner::control) and set `stop`.
  /// A RunError that it throws ends the run as one of a step does.
  std::function<void(Runner&, const dynamics::StepReport&)> after_step;
};

}  // namespace keyblock::simulation
