#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_line.h"
#include "commands.h"
#include "core/error.h"
#include "job/check.h"
#include "json_output.h"
#include "scenario/cut_summary.h"
#include "scenario_arguments.h"
#include "study/plan.h"

namespace keyblock::app {
namespace {

using nlohmann::ordered_json;

/// What a scenario that can be run comes to.
struct Checked {
  std::vector<std::string> warnings;
  std::size_t blocks = 0, traces = 0, stages = 0;
  std::vector<std::string> notes;
  std::optional<study::Plan> plan;
};

Checked checked(const ScenarioArguments& arguments) {
  const scenario::Scenario scenario = arguments.read();
  job::Checked of_run = job::check(scenario, arguments.realization);
  const cutting::BlockSystem& system = of_run.blocks.system;
  Checked found{.warnings = std::move(of_run.warnings),
                .blocks = system.blocks.size(),
                .traces = static_cast<std::size_t>(system.statistics.traces),
                .stages = scenario.stages.size(),
                .notes = scenario::sliver_notes(scenario, system),
                .plan = {}};
  found.notes.insert(found.notes.begin(), of_run.notes.begin(), of_run.notes.end());
  // Every combination of values is looked at here.
  if (scenario.study) {
    std::vector<std::string> of_study;
    found.plan = study::make_plan(arguments.file, arguments.overrides, KEYBLOCK_VERSION, &of_study);
    for (std::string& warning : of_study)
      if (std::ranges::find(found.warnings, warning) == found.warnings.end())
        found.warnings.push_back(std::move(warning));
  }
  return found;
}

std::string counted(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

void check_scenario(const ScenarioArguments& arguments) {
  const Checked found = checked(arguments);
  print_warnings(arguments, found.warnings);
  std::string text = fmt::format("{}: ok: {}, {}, {}", arguments.file, counted(found.blocks, "block"),
                                 counted(found.traces, "joint trace"), counted(found.stages, "stage"));
  if (found.plan) {
    const auto realizations = static_cast<std::size_t>(found.plan->realizations);
    text += fmt::format("; a study of {}{}: {}, {} of each", found.plan->until ? "at most " : "",
                        counted(found.plan->runs.size(), "run"), counted(realizations, "realization"),
                        found.plan->runs.size() / realizations);
  }
  std::cout << text << '\n';
  for (const std::string& note : found.notes) std::cout << arguments.file << ": " << note << '\n';
}

/// For other programs. Mistakes are printed here, and the exit code says that there are some.
void check_as_json(const ScenarioArguments& arguments, int& exit_code) {
  ordered_json json{{"scenario", arguments.file}, {"ok", true}, {"mistakes", ordered_json::array()}};
  try {
    const Checked found = checked(arguments);
    json["warnings"] = found.warnings;
    json["notes"] = found.notes;
    json["blocks"] = found.blocks;
    json["traces"] = found.traces;
    json["stages"] = found.stages;
    if (found.plan)
      json["study"] = {{"runs", found.plan->runs.size()}, {"realizations", found.plan->realizations}};
  } catch (const InputError& error) {
    json["ok"] = false;
    json["mistakes"] = mistakes_json(error.diagnostics());
    exit_code = input_wrong;
  }
  print_json(json);
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ScenarioArguments>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("check", "Every mistake of a scenario, with line and column");
  add_scenario_arguments(*command, *arguments);
  command->add_flag("--json", *as_json,
                    "For other programs: mistakes and warnings as JSON on standard output");
  command->footer("Exit code 1 if there is any mistake.\n\nExample:\n  keyblock check tunnel.toml");
  command->callback([arguments, as_json, &exit_code] {
    if (*as_json) return check_as_json(*arguments, exit_code);
    check_scenario(*arguments);
  });
}

}  // namespace keyblock::app
