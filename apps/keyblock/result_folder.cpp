#include "result_folder.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "simulation/checkpoint.h"

namespace keyblock::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* input_name = "scenario.toml";
constexpr const char* result_name = "result.h5";

[[noreturn]] void refuse(const fs::path& place, std::string found, std::string expected, std::string hint) {
  Diagnostic diagnostic;
  diagnostic.where.file = place.string();
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

}  // namespace

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder, error)) {
    refuse(folder, error ? error.message() : "a file", "a folder, or a place where one can be made", "");
  }
}

void check_holds_no_run(const fs::path& folder) {
  if (fs::exists(folder / result_name)) refuse(folder, "the results of a run", "another folder", "");
}

ResultFolder::ResultFolder(fs::path folder, const simulation::RunSetup& setup, Use use)
    : folder_(std::move(folder)),
      input_(fmt::format("{}\n# realization {}\n", setup.scenario, setup.realization)) {
  make_folder(folder_);
  const fs::path input = folder_ / input_name;
  const bool same = fs::exists(input) && read_file(input) == input_;
  if (fs::exists(folder_ / result_name) && !same && use != Use::replace) {
    refuse(folder_, "results of other input",
           use == Use::resume ? "those of this scenario with the same --set and --realization"
                              : "another folder, or --force to replace them",
           "the input of the results there is in " + input.string());
  }
  resumes_ = use == Use::resume && same && fs::exists(simulation::checkpoint_path(folder_));
}

void ResultFolder::begin(const simulation::ModelRecord&) {
  if (resumes_) return;
  for (const char* name : {"summary.json", "histories.csv", "report.html"}) fs::remove(folder_ / name);
  fs::remove(simulation::checkpoint_path(folder_));
  write_file_atomically(folder_ / input_name, input_);
}

}  // namespace keyblock::app
