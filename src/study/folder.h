#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "core/folder.h"
#include "study/plan.h"

/// The folder of a study:
///
///   study.toml            the scenario, copied
///   limit.json            the folder is that of a limit (limit.h), whose runs are planned one after the other
///   plan.json             what is to be run
///   lock                  held by the process that plans or runs the study here
///   runs/KEY/run.json     the measures of a run; written last: where it is, the run is done
///   runs/KEY/failed.json  in its place, why the run failed the last time
///   runs/KEY/log.txt      what the run said
///   runs/KEY/…            thumbnail.svg, report.html, summary.json, result.h5, as far as they are kept
namespace keyblock::study {

std::filesystem::path plan_path(const std::filesystem::path& directory);
std::filesystem::path scenario_path(const std::filesystem::path& directory);
std::filesystem::path limit_path(const std::filesystem::path& directory);
std::filesystem::path run_folder(const std::filesystem::path& directory, const std::string& key);

/// Makes the folder of a run where it is missing, and returns it. Throws InputError when a link or a file is in its place: what lies
/// behind a link is not the study's.
std::filesystem::path make_run_folder(const std::filesystem::path& directory, const std::string& key);

/// Takes away what an attempt at a run that did not end has left in its folder: files of the names above and their temporary ones,
/// nothing else. Throws RunError.
void clean_run_folder(const std::filesystem::path& folder);

/// Locks the study for planning and running. Throws InputError when another process has it, or the folder cannot be made.
std::unique_ptr<FileLock> lock_study(const std::filesystem::path& directory);

/// Puts the plan into the folder. A folder that holds a plan already is gone on with only if `resume`, and only if it is of the
/// same study: same scenario except for [study], same files, same version of the program, and the same raster of maps where runs
/// are done. Runs keep their places (keep_places), and files that earlier plans named stay known with their content. Throws
/// InputError that names what differs; the folder is then as it was.
void enter_plan(const std::filesystem::path& directory, Plan& plan, bool resume);

/// The same for a limit, whose plan has one axis of one key: the runs that are there stay in the plan, whatever was asked of that key
/// before. `conclusion` is what limit.json says until the limit is known.
void enter_limit(const std::filesystem::path& directory, Plan& plan, bool resume,
                 const std::string& conclusion);

/// Throws InputError when the folder is that of a limit.
void check_is_no_limit(const std::filesystem::path& directory);

/// Writes plan.json: runs have been added, or others are wanted.
void write_plan(const std::filesystem::path& directory, const Plan& plan);

/// What a run has left.
struct RunState {
  enum class Kind { missing, done, failed, damaged } kind = Kind::missing;
  RunResult result;     ///< done and failed
  std::string problem;  ///< failed and damaged, with the name of the file
};
/// Realization, values and variant are as `plan` has them: its axes may stand in another order than when the run was made.
RunState read_run_state(const std::filesystem::path& directory, const Plan& plan, const PlannedRun& run);

/// The identity of what is run, as run.json keeps it.
std::string run_input(const Plan& plan);

/// A result of this run without measures.
RunResult empty_result(const PlannedRun& run);

void write_failure(const std::filesystem::path& directory, const Plan& plan, const RunResult& result);
/// Throws RunError when it cannot be removed.
void remove_failure(const std::filesystem::path& directory, const PlannedRun& run);

}  // namespace keyblock::study
