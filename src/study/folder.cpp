#include "study/folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/folder.h"
#include "core/own_file.h"
#include "scenario/parse.h"
#include "study/plan_json.h"
#include "study/refusal.h"
#include "study/run_json.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_differences = 5;  // that are named

constexpr const char* run_files[] = {"run.json",     "failed.json",   "thumbnail.svg", "report.html",
                                     "summary.json", "histories.csv", "result.h5"};

// What makes two plans those of different studies.
std::vector<std::string> differences(const Plan& there, const Plan& here) {
  std::vector<std::string> found;
  if (there.version != here.version)
    found.push_back(fmt::format("version {} of keyblock there, {} here", there.version, here.version));
  if (there.input != here.input) {
    const auto document = [](const Plan& plan) {
      return scenario::document_without_study(plan.text, plan.scenario, plan.overrides);
    };
    for (const std::string& line : scenario::differences(document(there), document(here)))
      found.push_back(line);
  }
  std::map<std::string, std::string> hashes;
  for (const InputFile& file : there.files) hashes[file.name] = file.hash;
  for (const InputFile& file : here.files) {
    const auto known = hashes.find(file.name);
    if (known != hashes.end() && known->second != file.hash) found.push_back("the content of " + file.name);
  }
  return found;
}

// Runs of values that were dropped stay, and are used when their values come back: with the files as they were.
void keep_files(const std::vector<InputFile>& earlier, Plan& plan) {
  for (const InputFile& file : earlier) {
    const bool there = std::any_of(plan.files.begin(), plan.files.end(),
                                   [&](const InputFile& known) { return known.name == file.name; });
    if (!there) plan.files.push_back(file);
  }
}

bool same_raster(const MapGrid& a, const MapGrid& b) {
  return a.corner == b.corner && a.cell == b.cell && a.columns == b.columns && a.rows == b.rows;
}

// Maps of different rasters cannot be added up.
void check_same_raster(const fs::path& directory, const Plan& there, const Plan& here) {
  if (same_raster(there.grid, here.grid)) return;
  const bool any_done = std::any_of(there.runs.begin(), there.runs.end(), [&](const PlannedRun& run) {
    return fs::exists(run_folder(directory, run.key) / "run.json");
  });
  if (!any_done) return;
  refuse(directory.string(),
         fmt::format("runs with a map of other cells (study.map.cell: {} there, {} here)", there.grid.cell,
                     here.grid.cell),
         "the cells of the runs that are done", "set study.map.cell as it was, or take another folder");
}

void check_same_study(const fs::path& directory, const Plan& there, const Plan& here) {
  const std::vector<std::string> found = differences(there, here);
  if (found.empty()) return;
  std::string text = "another study: ";
  for (std::size_t k = 0; k < std::min(found.size(), most_differences); ++k)
    text += (k == 0 ? "" : "; ") + found[k];
  if (found.size() > most_differences) text += fmt::format("; and {} more", found.size() - most_differences);
  refuse(directory.string(), text, "a study that differs in nothing but [study]", "take another folder");
}

// The runs of a limit are told apart by the values of one key.
void check_same_key(const fs::path& directory, const Plan& there, const Plan& here) {
  const std::string key = there.axes.empty() ? "" : there.axes.front().key_text();
  if (key == here.axes.front().key_text()) return;
  refuse(directory.string(), "a limit of " + key, here.axes.front().key_text(), "take another folder");
}

// In a folder without a plan: of a study whose plan was lost, or of somebody else.
void check_holds_no_other_files(const fs::path& directory, const Plan& plan) {
  const auto refuse_foreign = [&](const char* name) {
    refuse((directory / name).string(), "a file that is of no study",
           "another folder, or another name for the file");
  };
  if (file_exists(scenario_path(directory))) {
    if (read_own_file(scenario_path(directory)) != plan.text) refuse_foreign("study.toml");
    return;
  }
  for (const char* name : {"runs", "runs.csv", "study.json", "report.html"})
    if (file_exists(directory / name)) refuse_foreign(name);
}

}  // namespace

fs::path plan_path(const fs::path& directory) {
  return directory / "plan.json";
}

fs::path scenario_path(const fs::path& directory) {
  return directory / "study.toml";
}

fs::path limit_path(const fs::path& directory) {
  return directory / "limit.json";
}

fs::path run_folder(const fs::path& directory, const std::string& key) {
  return directory / "runs" / key;
}

fs::path make_run_folder(const fs::path& directory, const std::string& key) {
  make_plain_folder(directory / "runs");
  const fs::path folder = run_folder(directory, key);
  make_plain_folder(folder);
  return folder;
}

void clean_run_folder(const fs::path& folder) {
  for (const char* name : run_files) {
    const fs::path file = folder / name;
    std::error_code error;
    fs::remove(file, error);
    if (error) throw RunError(fmt::format("{}: cannot remove: {}", file.string(), error.message()));
    remove_stale_temporaries(file);
  }
}

std::unique_ptr<FileLock> lock_study(const fs::path& directory) {
  make_folder(directory);
  auto lock = std::make_unique<FileLock>(directory / "lock");
  if (!lock->held()) {
    refuse(directory.string(), fmt::format("a study that {} is running", lock->holder()),
           "a folder that no other process works in", "wait until it has ended");
  }
  return lock;
}

void enter_plan(const fs::path& directory, Plan& plan, bool resume) {
  check_is_no_limit(directory);
  if (file_exists(plan_path(directory))) {
    const Plan there = read_plan(directory);
    check_same_study(directory, there, plan);
    if (resume) check_same_raster(directory, there, plan);
    if (!resume) {
      refuse(directory.string(), fmt::format("a study of {} runs", there.wanted()),
             "a new folder, or --resume to go on with what is there");
    }
    keep_places(there.runs, plan);
    keep_files(there.files, plan);
  } else if (file_exists(directory / "result.h5")) {
    refuse(directory.string(), "the results of a run", "another folder");
  } else {
    check_holds_no_other_files(directory, plan);
  }
  make_plain_folder(directory / "runs");
  write_file_atomically(scenario_path(directory), plan.text);
  write_plan(directory, plan);
}

void enter_limit(const fs::path& directory, Plan& plan, bool resume, const std::string& conclusion) {
  if (file_exists(plan_path(directory))) {
    if (!file_exists(limit_path(directory))) refuse(directory.string(), "a study", "another folder");
    const Plan there = read_plan(directory);
    check_same_study(directory, there, plan);
    check_same_raster(directory, there, plan);
    check_same_key(directory, there, plan);
    if (!resume)
      refuse(directory.string(), fmt::format("a limit of {} runs", there.runs.size()),
             "a new folder, or --resume to go on with what is there");
    plan.runs = there.runs;
    keep_files(there.files, plan);
  } else if (file_exists(directory / "result.h5")) {
    refuse(directory.string(), "the results of a run", "another folder");
  } else if (!file_exists(limit_path(directory))) {
    check_holds_no_other_files(directory, plan);
  }
  make_plain_folder(directory / "runs");
  write_file_atomically(limit_path(directory), conclusion);
  write_file_atomically(scenario_path(directory), plan.text);
  write_plan(directory, plan);
}

void check_is_no_limit(const fs::path& directory) {
  if (!file_exists(limit_path(directory))) return;
  refuse(directory.string(), "the runs of a limit", "a study, or another folder",
         "keyblock limit --resume goes on with it");
}

void write_plan(const fs::path& directory, const Plan& plan) {
  write_file_atomically(plan_path(directory), plan_json(plan, directory));
}

std::string run_input(const Plan& plan) {
  // What is drawn hangs on the number of realizations where it is stratified over them.
  const std::string strata = plan.strata > 0 ? fmt::format("-{}", plan.strata) : "";
  return plan.input + strata + "-" + plan.version;
}

RunResult empty_result(const PlannedRun& run) {
  RunResult result;
  result.key = run.key;
  result.realization = run.realization;
  result.variant = run.variant;
  for (const auto& row : run.values) {
    std::string text;
    for (const std::string& value : row) text += (text.empty() ? "" : ", ") + value;
    result.values.push_back(std::move(text));
  }
  return result;
}

RunState read_run_state(const fs::path& directory, const Plan& plan, const PlannedRun& run) {
  RunState state;
  const fs::path folder = run_folder(directory, run.key);
  const auto read = [&](const fs::path& path) {
    try {
      state.result = read_run_json(read_own_file(path), run_input(plan));
      if (state.result.key != run.key) {
        state.problem = fmt::format("{}: found the run {}", path.string(), state.result.key);
        return false;
      }
      const RunResult planned = empty_result(run);
      state.result.realization = planned.realization;
      state.result.values = planned.values;
      state.result.variant = planned.variant;
      return true;
    } catch (const InputError& error) {
      const Diagnostic& d = error.diagnostics().front();
      state.problem = fmt::format("{}: found {}", path.string(), d.found);
      return false;
    }
  };
  if (file_exists(folder / "run.json")) {
    state.kind = read(folder / "run.json") ? RunState::Kind::done : RunState::Kind::damaged;
  } else if (file_exists(folder / "failed.json")) {
    state.kind = RunState::Kind::failed;
    if (read(folder / "failed.json")) {
      state.problem = state.result.error;
    } else {
      state.result = empty_result(run);
      state.result.error = state.problem;
    }
  }
  return state;
}

void write_failure(const fs::path& directory, const Plan& plan, const RunResult& result) {
  const fs::path folder = make_run_folder(directory, result.key);
  write_file_atomically(folder / "failed.json", run_json(result, run_input(plan)));
}

void remove_failure(const fs::path& directory, const PlannedRun& run) {
  const fs::path file = run_folder(directory, run.key) / "failed.json";
  std::error_code error;
  fs::remove(file, error);
  if (error) throw RunError(fmt::format("{}: cannot remove: {}", file.string(), error.message()));
}

}  // namespace keyblock::study
