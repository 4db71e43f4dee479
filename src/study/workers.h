#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/collect.h"
#include "study/plan.h"

/// The runs of a study on this machine, each in a process of its own: what crashes or is killed costs one run.
namespace keyblock::study {

struct StudyProgress {
  std::size_t total = 0;  ///< runs the study asks for; with [study.until], the most it may ask for
  std::size_t done = 0, failed = 0, running = 0;
  double fraction = 0.0;       ///< of the whole, with the parts of the runs at hand
  double seconds_left = -1.0;  ///< negative: unknown
  std::string finished;        ///< key of the run that has just ended; empty: none has
  std::string failure;         ///< why it failed, if it did
};

struct WorkerOptions {
  int workers = 1;
  /// The program and its first words; `DIR INDEX --progress-descriptor N` is added. It must do what `keyblock study task` does.
  std::vector<std::string> command;
  const std::atomic<bool>* stop = nullptr;  ///< set: the runs at hand are interrupted, those done stay
  std::function<void(const StudyProgress&)> report = [](const StudyProgress&) {};
};

struct WorkerOutcome {
  std::size_t done = 0;             ///< now
  std::size_t before = 0;           ///< were there before
  std::vector<std::string> failed;  ///< keys, with why
  bool interrupted = false;
};

/// Runs all that is not done, by realization, then in the order of the plan, no run twice; with [study.until] until realizations
/// are enough. What failed before is tried again. Children write to runs/KEY/log.txt and die with this process. `files` is what is there (updated).
///
/// Throws RunError when no process can be started, or what failed cannot be written down (the disk is full); the children have
/// ended by then.
WorkerOutcome run_workers(const std::filesystem::path& directory, const Plan& plan, StudyFiles& files,
                          const WorkerOptions& options);

/// Passes the fraction of a run that is done on to its parent, as doubles through a pipe; stage k of a run counts as many
/// steps as it has, a settling stage as `settle_weight`.
class ProgressPipe : public record::RunObserver {
 public:
  ProgressPipe(int descriptor, const simulation::RunSetup& setup);
  void progress(const record::Progress& progress) override;

 private:
  int descriptor_;
  std::vector<double> weight_before_;  ///< of every stage, and the sum
};

}  // namespace keyblock::study
