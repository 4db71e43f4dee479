#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace CLI {
class App;
}

namespace keyblock::app {

/// What says which model is meant: S.toml --set key=value --realization K.
struct ScenarioArguments {
  std::string file;
  std::vector<std::string> overrides;
  int realization = 0;

  /// The scenario with its overrides. Throws InputError.
  [[nodiscard]] scenario::Scenario read() const;
};

/// Adds SCENARIO and --set to a command; `arguments` must outlive the parsing.
void add_scenario_file(CLI::App& command, ScenarioArguments& arguments);

/// Adds all of them to a command; `arguments` must outlive the parsing.
void add_scenario_arguments(CLI::App& command, ScenarioArguments& arguments);

/// Tells the user, on standard error, what seems wrong with the scenario although it can be run.
void print_warnings(const ScenarioArguments& arguments, const std::vector<std::string>& warnings);

}  // namespace keyblock::app
