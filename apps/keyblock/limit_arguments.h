#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <thread>

#include "scenario_arguments.h"
#include "study/limit.h"

namespace keyblock::app {

/// A search for a limit, as it is asked for.
struct LimitArguments {
  ScenarioArguments scenario;
  study::LimitRequest request;
  std::string until;  ///< empty: by the key or the model
  std::optional<double> above;
  std::string folder;
  int workers = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  bool resume = false;
};

/// Searches, and tells what is found. Throws InputError and RunError.
void run_limit(LimitArguments arguments);

/// --output and --workers.
void add_limit_folder(CLI::App& command, LimitArguments& arguments);
/// --realizations
void add_limit_realizations(CLI::App& command, study::LimitRequest& request);

}  // namespace keyblock::app
