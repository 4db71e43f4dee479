#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "json_output.h"
#include "study/folder.h"
#include "study/plan_json.h"
#include "study_commands.h"

namespace keyblock::app {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t most_named_runs = 20;  // one by one

struct StatusArguments {
  std::string folder;
  bool as_json = false;
};

void name_runs(const std::vector<std::string>& lines, const char* what) {
  for (std::size_t k = 0; k < std::min(lines.size(), most_named_runs); ++k)
    std::cout << what << ": " << lines[k] << "\n";
  if (lines.size() > most_named_runs)
    std::cout << what << ": and " << lines.size() - most_named_runs << " more\n";
}

/// Of the missing runs, those that have a folder: they are being run, or were stopped.
std::vector<std::string> begun_runs(const fs::path& folder, const study::StudyCount& count) {
  std::vector<std::string> begun;
  std::error_code error;
  for (const std::string& key : count.missing) {
    if (fs::exists(study::run_folder(folder, key), error)) begun.push_back(key);
  }
  return begun;
}

ordered_json status_json(const StatusArguments& arguments, const study::Plan& plan,
                         const study::StudyCount& count, const std::vector<std::string>& begun) {
  ordered_json json{{"study", arguments.folder}, {"title", plan.title}, {"version", plan.version}};
  json["complete"] = count.done == count.asked;
  json["runs"] = {{"asked", count.asked},
                  {"done", count.done},
                  {"failed", count.failed.size()},
                  {"damaged", count.damaged.size()},
                  {"missing", count.missing.size()},
                  {"begun", begun.size()}};
  json["enough"] = count.enough ? ordered_json(*count.enough) : ordered_json();
  json["lacking"] = count.lacking;
  json["failed"] = count.failed;
  json["damaged"] = count.damaged;
  json["missing"] = count.missing;
  json["begun"] = begun;
  return json;
}

void show_status(const StatusArguments& arguments) {
  study::check_is_no_limit(arguments.folder);
  const study::Plan plan = study::read_plan(arguments.folder);
  const study::StudyCount count = study::count_runs(plan, study::read_study_files(arguments.folder, plan));
  const std::vector<std::string> begun = begun_runs(arguments.folder, count);
  if (arguments.as_json) return print_json(status_json(arguments, plan, count, begun));
  print_count(count);
  std::cout << "\n";
  name_runs(begun, "begun");
}

}  // namespace

void print_count(const study::StudyCount& count) {
  name_runs(count.failed, "failed");
  name_runs(count.damaged, "damaged");
  name_runs(count.missing, "missing");
  if (count.enough) std::cout << "enough: " << *count.enough << " realizations\n";
  if (!count.lacking.empty()) std::cout << "not narrow enough: " << count.lacking << "\n";
  std::cout << fmt::format("{} of {} runs done", count.done, count.asked);
  const auto number = [](const std::vector<std::string>& keys, const char* what) {
    if (!keys.empty()) std::cout << ", " << keys.size() << " " << what;
  };
  number(count.failed, "failed");
  number(count.damaged, "damaged");
  number(count.missing, "missing");
}

void add_study_status(CLI::App& study) {
  auto arguments = std::make_shared<StatusArguments>();
  CLI::App* command = study.add_subcommand(
      "status", "How many runs are done, and which failed or are missing; changes nothing");
  command->add_option("DIR", arguments->folder, "Folder of the study")->required();
  command->add_flag("--json", arguments->as_json,
                    "For other programs: numbers and names of runs as JSON on standard output");
  command->footer("Example:\n  keyblock study status out/study --json");
  command->callback([arguments] { show_status(*arguments); });
}

}  // namespace keyblock::app
