#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "job/result_folder.h"
#include "record/fan_out.h"
#include "results/result_writer.h"
#include "scenario/scenario.h"
#include "simulation/runner.h"

namespace keyblock::job {

/// A run whose results go to a folder: what `keyblock run` does, step by step.
///
///     RecordedRun run(scenario, setup, options, observer);
///     if (!run.has_ended()) run.start();
///     while (!run.runner().done()) run.advance();
///     const record::RunRecord record = run.finish();
///
/// The folder belongs to this process until finish() or close(), or while the object lives. An object that is closed or destroyed before
/// finish() leaves what a killed run leaves: results up to the last flush, and a checkpoint.
class RecordedRun {
 public:
  struct Options {
    std::filesystem::path folder;
    ResultFolder::Use use = ResultFolder::Use::fresh;
    simulation::RunOptions run;  ///< its directory and `resume` are set from `folder` and `use`
  };

  /// Takes hold of the folder. `setup` and `observer` must outlive the run. Throws InputError as ResultFolder does.
  RecordedRun(const scenario::Scenario& scenario, const simulation::RunSetup& setup, Options options,
              record::RunObserver& observer);

  /// Whether the run that is to be resumed has come to its end already: start() must not be called then.
  [[nodiscard]] bool has_ended() const { return guard_.has_ended(); }
  /// Whether the run goes on from what is in the folder.
  [[nodiscard]] bool resumes() const { return guard_.resumes(); }
  /// Makes the model, or reads the checkpoint. Throws InputError and RunError as Runner does.
  void start();
  /// One step of the plan. Where the run cannot go on, the report is written before the RunError is passed on.
  simulation::Advance advance();
  /// Ends the run where it is; the page is written. The folder is let go, also where that fails.
  record::RunRecord finish();
  /// Lets the folder go. The runner must not advance after that.
  void close();
  /// After start().
  [[nodiscard]] simulation::Runner& runner() { return *runner_; }

 private:
  template <typename Work>
  decltype(auto) with_report_of_failure(const Work& work);

  const simulation::RunSetup& setup_;
  Options options_;
  ResultFolder guard_;
  results::ResultWriter writer_;
  record::FanOut observers_;
  std::optional<simulation::Runner> runner_;
};

/// The files that a run of this scenario reads, with the scenario itself.
std::vector<std::filesystem::path> files_read(const scenario::Scenario& scenario);

/// Writes DIR/report.html from what the result file holds. Throws RunError when memory runs out.
void write_report(const std::filesystem::path& folder);

/// What a run that has ended wrote from its results and is there no more, or empty, is written again: the page, histories.csv.
void restore_conclusions(const std::filesystem::path& folder);

}  // namespace keyblock::job
