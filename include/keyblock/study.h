#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "keyblock/export.h"
#include "keyblock/scenario.h"

/// A study: realizations × values of keys, each a run of its own, in a folder that several processes may work at. docs/studies.md.
namespace keyblock {

/// Makes the plan of a study from a scenario that was loaded from a file, and puts it into the folder. `resume`: goes on with what is there;
/// runs that failed are tried again. Returns warnings. Throws InputError with all mistakes, for a scenario that was not loaded from a file,
/// and for a folder with another study.
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

/// Gathers the runs that are there: runs.csv, study.json, report.html. Throws InputError when the folder holds no plan.
KEYBLOCK_API void collect_study(const std::filesystem::path& folder);

}  // namespace keyblock
