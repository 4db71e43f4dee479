#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "commands.h"
#include "scenario/build.h"
#include "scenario/cut_summary.h"
#include "scenario/inputs.h"
#include "scenario_arguments.h"
#include "simulation/build_model.h"
#include "simulation/feasibility.h"
#include "study/plan.h"

namespace keyblock::app {
namespace {

void check_scenario(const ScenarioArguments& arguments) {
  const scenario::Scenario scenario = arguments.read();
  std::vector<std::string> warnings = scenario::check_inputs(scenario);
  const scenario::BlockModel blocks = scenario::build_blocks(scenario, arguments.realization);
  if (!scenario.stages.empty()) {  // a scenario without stages can still be cut
    warnings.clear();
    const simulation::RunSetup setup =
        scenario::build_setup(scenario, arguments.realization, blocks, &warnings);
    simulation::build_model(setup);
    if (const auto reason = simulation::yields_without_limit(setup))
      warnings.push_back("a run ends at once: " + *reason);
  } else {
    scenario::add_block_warnings(scenario, blocks, warnings);
    scenario::add_overlap_warnings(scenario, blocks.system, warnings);
  }
  print_warnings(arguments, warnings);
  print_warnings(arguments, scenario::study_warnings(scenario));
  const auto count = [](std::size_t n, const char* what) {
    return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
  };
  std::string text =
      fmt::format("{}: ok: {}, {}, {}", arguments.file, count(blocks.system.blocks.size(), "block"),
                  count(static_cast<std::size_t>(blocks.system.statistics.traces), "joint trace"),
                  count(scenario.stages.size(), "stage"));
  if (scenario.study) {
    // Every combination of values is looked at here.
    const study::Plan plan = study::make_plan(arguments.file, arguments.overrides, KEYBLOCK_VERSION);
    const auto realizations = static_cast<std::size_t>(plan.realizations);
    text += fmt::format("; a study of {}{}: {}, {} of each", plan.until ? "at most " : "",
                        count(plan.runs.size(), "run"), count(realizations, "realization"),
                        plan.runs.size() / realizations);
  }
  std::cout << text << '\n';
  if (const auto note = scenario::sliver_note(blocks.system, scenario.blocks.size()))
    std::cout << arguments.file << ": " << *note << '\n';
}

}  // namespace

void add_check(CLI::App& app) {
  auto arguments = std::make_shared<ScenarioArguments>();
  CLI::App* command = app.add_subcommand("check", "Every mistake of a scenario, with line and column");
  add_scenario_arguments(*command, *arguments);
  command->footer("Exit code 1 if there is any mistake.\n\nExample:\n  keyblock check tunnel.toml");
  command->callback([arguments] { check_scenario(*arguments); });
}

}  // namespace keyblock::app
