#pragma once
#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "verification/builtin.h"
#include "verification/case_file.h"

namespace keyblock::verification {

/// One simulation of a run: its scenario with these overrides.
struct Simulation {
  std::vector<std::string> overrides;  ///< key=value, all of them
  std::optional<int> order;            ///< where the run has orders
  Parameters parameters;               ///< those that differ between the simulations of the run
  std::optional<std::size_t> point;    ///< place in the list of points of the run
  std::string label;                   ///< for people: the parameters in short
};

/// The simulations of a run: orders × points × grid, the last axis of the grid running fastest. A built-in check is one.
std::vector<Simulation> simulations(const RunSpec& run);

/// Forces of all contacts between two blocks at the end, N per metre of thickness.
struct PairForces {
  double normal = 0.0;  ///< compression positive
  double shear = 0.0;   ///< size of the sum
};

/// What a simulation leaves, as far as quantities ask for it.
struct Outcome {
  std::string failure;                    ///< why it could not go on; empty: it ended well
  double wall_time = 0.0;                 ///< s
  std::optional<int> order;               ///< rock.order; none where the program chooses it
  std::vector<std::string> columns;       ///< of the histories: time, NAME.ux, …
  std::vector<std::vector<double>> rows;  ///< of the histories
  std::map<std::string, std::size_t, std::less<>> stage_rows;  ///< rows there were at the end of a stage
  std::map<std::pair<std::string, std::string>, PairForces> forces;  ///< by names of blocks
  /// Numbers of the summary by path; of several realizations their mean and its standard error. The last 13 digits of a
  /// hash count as a number.
  std::map<std::string, double, std::less<>> summary, standard_error;
  BuiltinResults results;
};

/// Runs it on one thread. Throws InputError when the scenario is wrong.
Outcome simulate(const RunSpec& run, const Simulation& simulation, const std::string& version,
                 const std::atomic<bool>* stop);

}  // namespace keyblock::verification
