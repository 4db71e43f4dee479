#pragma once
#include <optional>
#include <string>
#include <vector>

#include "verification/case_file.h"
#include "verification/simulate.h"

namespace keyblock::verification {

/// What was computed, what is known, and whether they agree.
struct Row {
  std::string run, quantity, unit;
  std::optional<int> order;
  Parameters parameters;
  std::string label;      ///< the parameters in short
  double computed = 0.0;  ///< NaN: the simulation failed, or there is no such number
  std::optional<double> expected, at_most, at_least;
  std::optional<double> relative_error;  ///< (computed − expected)/|expected|; none where expected is 0
  std::optional<double> published;
  std::string source;
  std::optional<double> tolerance;           ///< relative
  std::optional<double> absolute_tolerance;  ///< in the unit of the quantity
  bool pass = false;
  std::string failure;     ///< why there is no number
  double wall_time = 0.0;  ///< s of the simulation
};

/// A run with the simulations that were made of it.
struct SolvedRun {
  const RunSpec* spec = nullptr;
  std::vector<Simulation> simulations;
  std::vector<Outcome> outcomes;  ///< one for each
};

/// The rows of a case, in the order of the file: by run, quantity, simulation. A row whose expressions ask for what is not
/// there fails and says so.
std::vector<Row> make_rows(const std::vector<SolvedRun>& runs);

}  // namespace keyblock::verification
