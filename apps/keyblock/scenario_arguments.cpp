#include "scenario_arguments.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <limits>

#include "scenario/parse.h"

namespace keyblock::app {

scenario::Scenario ScenarioArguments::read() const {
  return scenario::parse_scenario(file, overrides);
}

void add_scenario_file(CLI::App& command, ScenarioArguments& arguments) {
  command.add_option("SCENARIO", arguments.file, "Scenario file, TOML")->required();
  command
      .add_option("--set", arguments.overrides,
                  "Put a value in the place of the file's, as in --set rock.order=2; once for each")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_scenario_arguments(CLI::App& command, ScenarioArguments& arguments) {
  add_scenario_file(command, arguments);
  command
      .add_option("--realization", arguments.realization,
                  "Which of the rock masses that the joint statistics and the seed stand for")
      ->check(CLI::Range(0, std::numeric_limits<int>::max()).description(""))
      ->capture_default_str()
      ->type_name("K");
}

void print_warnings(const ScenarioArguments& arguments, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    std::cerr << arguments.file << ": warning: " << warning << "\n";
  }
}

}  // namespace keyblock::app
