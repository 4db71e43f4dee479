#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "record/record.h"
#include "simulation/run_options.h"
#include "simulation/setup.h"
#include "study/plan.h"

namespace keyblock::study {

enum class TaskOutcome {
  done,         ///< run.json is there now
  was_done,     ///< it was there before; nothing was done
  not_asked,    ///< the scenario asks for the run no more, or enough realizations have been run (until.h)
  interrupted,  ///< by `stop`; nothing is kept, the run begins anew the next time
};

struct TaskOptions {
  const std::atomic<bool>* stop = nullptr;
  /// Makes those that are told of the run as it goes on, when it begins; may be empty.
  std::function<std::vector<std::unique_ptr<record::RunObserver>>(const simulation::RunSetup&)> observers;
  /// Programs that steer the run, with their hashes; and what is called after each step (RunOptions::after_step).
  std::vector<std::pair<std::string, std::string>> hooks;
  std::function<void(simulation::Runner&, const dynamics::StepReport&)> after_step;
};

/// Does one run of the plan in DIR, in this process with one thread, and leaves its folder as `keep` says, run.json last. An
/// attempt that did not end leaves nothing that counts; the next begins anew.
///
/// Throws RunError when another process is at the same run, and what the run throws; failed.json then says why. Throws
/// InputError when a file that the run reads has changed since the study was planned.
TaskOutcome run_task(const std::filesystem::path& directory, const Plan& plan, std::size_t index,
                     const TaskOptions& options);

/// The set-up of a run: the scenario with its overrides, as its variant.
simulation::RunSetup run_setup(const Plan& plan, const PlannedRun& run);

}  // namespace keyblock::study
