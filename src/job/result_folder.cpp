#include "job/result_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/own_file.h"
#include "results/run_data.h"
#include "simulation/checkpoint.h"

namespace keyblock::job {
namespace {

namespace fs = std::filesystem;

constexpr const char* input_name = "scenario.toml";
constexpr const char* result_name = "result.h5";
constexpr std::string_view steered_by = "# steered by ";
constexpr const char* conclusions[] = {"summary.json", "histories.csv", "report.html"};

// All files of a run.
std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> files{folder / input_name, folder / result_name, simulation::checkpoint_path(folder)};
  for (const char* name : conclusions) files.push_back(folder / name);
  return files;
}

[[noreturn]] void refuse(const fs::path& place, std::string found, std::string expected, std::string hint) {
  Diagnostic diagnostic;
  diagnostic.where.file = place.string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

std::string input_text(const simulation::RunSetup& setup) {
  std::string text = fmt::format("{}\n# realization {}\n", setup.scenario, setup.realization);
  for (const simulation::InputFile& file : setup.files)
    text += fmt::format("# content of {}: {}\n", file.name, file.hash);
  for (const auto& [name, hash] : setup.hooks) text += fmt::format("{}{}: {}\n", steered_by, name, hash);
  return text;
}

/// The input of a run without what steered it, and the names of that.
struct Steering {
  std::string rest, names;
};

Steering steering_of(std::string text) {
  Steering steering;
  while (text.size() > 1) {
    const std::size_t line = text.rfind('\n', text.size() - 2) + 1;
    if (!std::string_view(text).substr(line).starts_with(steered_by)) break;
    const std::size_t begin = line + steered_by.size(), end = text.rfind(": ");
    const std::string name = text.substr(begin, std::max(end, begin) - begin);
    steering.names = name + (steering.names.empty() ? "" : ", ") + steering.names;
    text.resize(line);
  }
  steering.rest = std::move(text);
  return steering;
}

void check_keeps_input(const fs::path& folder, const std::vector<fs::path>& inputs) {
  for (const fs::path& file : files_of(folder)) {
    for (const fs::path& input : inputs) {
      std::error_code error;
      if (!fs::equivalent(file, input, error)) continue;
      refuse(folder, fmt::format("{}, input of the run, which the run would write over", input.string()),
             "another folder", "");
    }
  }
}

// Of a run that is to be resumed. Where its results cannot be read, there is nothing to go on with.
bool results_have_ended(const fs::path& folder) {
  try {
    return results::has_ended(folder);
  } catch (const InputError& error) {
    Diagnostic diagnostic = error.diagnostics().front();
    diagnostic.hint = "to begin anew, run into another folder";
    throw InputError(std::move(diagnostic));
  }
}

void check_is_no_study(const fs::path& folder) {
  if (file_exists(folder / "plan.json")) refuse(folder, "a study", "another folder", "");
}

}  // namespace

void check_holds_no_run(const fs::path& folder) {
  if (file_exists(folder / result_name)) refuse(folder, "the results of a run", "another folder", "");
  check_is_no_study(folder);
}

ResultFolder::ResultFolder(fs::path folder, const std::vector<fs::path>& inputs,
                           const simulation::RunSetup& setup, Use use)
    : folder_(std::move(folder)), input_(input_text(setup)) {
  check_is_no_study(folder_);
  check_keeps_input(folder_, inputs);
  make_folder(folder_);
  lock_.emplace(folder_ / "lock", FileLock::Afterwards::remove_file);
  if (!lock_->held()) {
    if (lock_->held_by_this_process())
      refuse(folder_, "a simulation of this process that is at it", "a folder that no simulation works in",
             "its finish() or close() lets the folder go");
    refuse(folder_, fmt::format("a run that {} is at", lock_->holder()),
           "a folder that no other process works in", "wait until it has ended");
  }
  const fs::path input = folder_ / input_name;
  same_ = file_exists(input) && read_file(input) == input_;
  check_state(use);
  for (const fs::path& file : files_of(folder_)) remove_stale_temporaries(file);
  has_ended_ =
      use == Use::resume && same_ && file_exists(folder_ / result_name) && results_have_ended(folder_);
  resumes_ = use == Use::resume && same_ && file_exists(simulation::checkpoint_path(folder_));
}

void ResultFolder::check_state(Use use) const {
  if (use == Use::replace) return;
  const bool results = file_exists(folder_ / result_name);
  if (same_) {
    const fs::path checkpoint = simulation::checkpoint_path(folder_);
    if (use == Use::resume && !results && file_exists(checkpoint)) {
      refuse(folder_ / result_name, "no such file, but a " + checkpoint.filename().string(),
             "the results of the run to be resumed", "to begin anew, run into another folder");
    }
    return;
  }
  if (results && use == Use::resume) check_steering();
  if (results) {
    refuse(folder_, "results of other input",
           use == Use::resume ? "those of this scenario with the same files, --set and --realization"
                              : "another folder, or --force to replace them",
           "the input of the results there is in " + (folder_ / input_name).string());
  }
  for (const fs::path& file : files_of(folder_)) {
    if (!file_exists(file)) continue;
    refuse(folder_, fmt::format("a {} that is not of this run", file.filename().string()), "another folder",
           "or --force to replace it");
  }
}

/// Of the same input, but steered by others: gone on with, it would be neither run.
void ResultFolder::check_steering() const {
  const fs::path input = folder_ / input_name;
  if (!file_exists(input)) return;
  const Steering before = steering_of(read_file(input)), now = steering_of(input_);
  if (before.rest != now.rest) return;
  const std::string hint = "to begin anew, run into another folder";
  if (before.names.empty())
    refuse(folder_, "results of a run without controllers", "the same run, and none of " + now.names, hint);
  if (now.names.empty())
    refuse(folder_, "results of a run that controllers of a program have steered: " + before.names,
           "the same controllers, from that program; the rest would run without them", hint);
  refuse(folder_, "results of a run that other controllers have steered: " + before.names,
         before.names == now.names ? "the same ones; their text has changed"
                                   : "the same ones, and not " + now.names,
         hint);
}

void ResultFolder::enter() {
  if (resumes_) return;
  write_file_atomically(folder_ / input_name, input_);
  std::vector<fs::path> outdated{simulation::checkpoint_path(folder_)};
  for (const char* name : conclusions) outdated.push_back(folder_ / name);
  for (const fs::path& file : outdated) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw RunError(fmt::format("{}: cannot remove: {}", file.string(), error.message()));
  }
  entered_ = true;
}

}  // namespace keyblock::job
