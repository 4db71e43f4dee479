#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "keyblock/export.h"
#include "keyblock/scenario.h"
#include "keyblock/simulation.h"

/// A study: realizations × values of keys, each a run of its own, in a folder that several processes may work at. docs/studies.md.
namespace keyblock {

/// Makes the plan of a study and puts it into the folder. `resume`: goes on with what is there; runs that failed are tried again. Returns
/// warnings. Throws InputError with all mistakes, and for a folder with another study.
KEYBLOCK_API std::vector<std::string> plan_study(const Scenario& scenario,
                                                 const std::filesystem::path& folder, bool resume = false);

/// How far a study is.
struct StudyState {
  std::size_t runs = 0;               ///< that it asks for
  std::vector<std::size_t> missing;   ///< places in the plan of runs that are neither done nor failed
  std::vector<std::string> failures;  ///< why runs failed, one sentence each
};
KEYBLOCK_API StudyState study_state(const std::filesystem::path& folder);

/// Does one run of the plan, in this process with one thread. Does nothing when it is done already, or asked for no more. Throws RunError
/// when another process is at it, and what the run throws; the folder then says why.
KEYBLOCK_API void run_of_study(const std::filesystem::path& folder, std::size_t run);

/// The same of a run that is steered: `steer` is called after each step, as Simulation::after_step is. The simulation is that of the run; it can be
/// looked at and changed, not stepped, and not after the run. A run that steer() stops, or throws in, has failed. `hooks` as in RunOptions.
KEYBLOCK_API void run_of_study(const std::filesystem::path& folder, std::size_t run,
                               const std::vector<std::pair<std::string, std::string>>& hooks,
                               const std::function<void(Simulation&)>& steer);

/// Writes down that a run has failed, of which only its process could tell no more: it was killed.
KEYBLOCK_API void note_failed_run(const std::filesystem::path& folder, std::size_t run,
                                  const std::string& why);

/// Processes of this machine that do runs, each one run.
struct Workers {
  int count = 1;
  /// A program and its first words, to which `FOLDER RUN` and words that it may pass over are added. It calls run_of_study(FOLDER, RUN) and
  /// ends with 0 where that throws nothing: `keyblock study task` is one.
  std::vector<std::string> command;
  /// Told now and then of runs that have ended and of all; false stops the study.
  std::function<bool(std::size_t ended, std::size_t all)> progress;
};

/// Does all runs of the plan that are not done. A process that is killed is one failed run. Throws RunError where no process can be started.
KEYBLOCK_API void run_study(const std::filesystem::path& folder, const Workers& workers);

/// Gathers the runs that are there: runs.csv, study.json, report.html. Throws InputError when the folder holds no plan.
KEYBLOCK_API void collect_study(const std::filesystem::path& folder);

/// What `keyblock limit` is asked for.
struct LimitRequest {
  std::string key;              ///< key path of a number
  double from = 0.0, to = 0.0;  ///< the criterion does not hold at `from`, and holds at `to`
  std::string until;  ///< fallen, moved, collapsed, or a measure of summary.json; empty: by the model
  std::optional<double> above;  ///< it holds when the measure is above this
  std::string since;            ///< stage at whose end the measure begins; empty: the first excavation
  double tolerance = 0.02;      ///< width of the bracket over the larger of its ends
  int realizations = 1;
  bool resume = false;
  int scan = 0;  ///< equal parts of the way that are looked at before; 0: 8 for the scale of a motion, else 1
};

/// The value of a number of the scenario at which rock first falls, moves or collapses; limit.json as text, which is in the folder, too.
/// Throws InputError with all mistakes, and RunError where runs have failed or the search was stopped.
KEYBLOCK_API std::string find_limit(const Scenario& scenario, const std::filesystem::path& folder,
                                    const LimitRequest& request, const Workers& workers);

}  // namespace keyblock
