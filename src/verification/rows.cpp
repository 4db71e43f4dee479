#include "verification/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scenario/override.h"
#include "verification/histories.h"

namespace keyblock::verification {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

// Computed values of a run: [quantity][simulation].
using Values = std::map<std::string, std::vector<double>>;

struct Solved {
  const SolvedRun* run;
  Values values;
};

std::string text(const Argument& argument) {
  return std::get<std::string>(argument);
}

double number_of_value(const scenario::Value& value, const std::string& key) {
  if (!value.is_number()) throw std::runtime_error(fmt::format("'{}' is {}", key, scenario::describe(value)));
  return value.number;
}

/// What the expressions of one simulation may ask for.
class SimulationQuantities final : public Quantities {
 public:
  SimulationQuantities(const std::vector<Solved>& before, const Solved& here, std::size_t simulation)
      : before_(before), here_(here), index_(simulation) {}

  [[nodiscard]] double get(std::string_view function, const std::vector<Argument>& arguments) const override {
    if (function == "summary") return member(outcome().summary, text(arguments[0]), "number in the summary");
    if (function == "standard_error") {
      return member(outcome().standard_error, text(arguments[0]), "number in the summaries of realizations");
    }
    if (function == "result") return member(outcome().results, text(arguments[0]), "result");
    if (function == "set") return setting(text(arguments[0]));
    if (function == "order") return order();
    if (function == "row") return row(text(arguments[0]), text(arguments[1]));
    if (function == "normal_force") return forces(arguments).normal;
    if (function == "shear_force") return forces(arguments).shear;
    return history_quantity(outcome(), function, arguments);
  }

 private:
  [[nodiscard]] const Simulation& simulation() const { return here_.run->simulations[index_]; }
  [[nodiscard]] const Outcome& outcome() const { return here_.run->outcomes[index_]; }

  static double member(const std::map<std::string, double, std::less<>>& numbers, const std::string& name,
                       std::string_view what) {
    const auto found = numbers.find(name);
    if (found == numbers.end()) throw std::runtime_error(fmt::format("there is no {} '{}'", what, name));
    return found->second;
  }

  [[nodiscard]] double order() const {
    const std::optional<int> order = simulation().order ? simulation().order : outcome().order;
    if (!order) throw std::runtime_error("the order is chosen by the program");
    return *order;
  }

  // 'gravity.0' is the first number of an array.
  [[nodiscard]] double setting(const std::string& key) const {
    const auto& overrides = simulation().overrides;
    const auto dot = key.rfind('.');
    for (auto text = overrides.rbegin(); text != overrides.rend(); ++text) {
      const auto equals = text->find('=');
      const std::string own = text->substr(0, equals);
      const scenario::Value value = scenario::parse_override(*text).value;
      if (own == key) return number_of_value(value, key);
      if (dot == std::string::npos || own != key.substr(0, dot) || !value.is(scenario::Value::Type::array))
        continue;
      const std::string place = key.substr(dot + 1);
      if (place.size() == 1 && place[0] >= '0' &&
          static_cast<std::size_t>(place[0] - '0') < value.items.size()) {
        return number_of_value(value.items[static_cast<std::size_t>(place[0] - '0')], key);
      }
    }
    throw std::runtime_error(fmt::format("no override sets '{}'", key));
  }

  [[nodiscard]] PairForces forces(const std::vector<Argument>& arguments) const {
    std::pair pair(text(arguments[0]), text(arguments[1]));
    if (pair.first > pair.second) std::swap(pair.first, pair.second);
    const auto found = outcome().forces.find(pair);
    return found == outcome().forces.end() ? PairForces{} : found->second;
  }

  // The row of the simulation with the same parameters, or of the only one, or of that at the same place.
  [[nodiscard]] double row(const std::string& run, const std::string& quantity) const {
    const Solved* solved = run == here_.run->spec->name ? &here_ : nullptr;
    for (const Solved& other : before_) {
      if (other.run->spec->name == run) solved = &other;
    }
    if (solved == nullptr) throw std::runtime_error(fmt::format("there is no run '{}' before this one", run));
    const auto values = solved->values.find(quantity);
    if (values == solved->values.end()) {
      throw std::runtime_error(
          fmt::format("the run '{}' has no quantity '{}' before this one", run, quantity));
    }
    const auto& all = solved->run->simulations;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool same = all[k].order == simulation().order && all[k].parameters == simulation().parameters;
      if (same) return values->second[k];
    }
    if (all.size() == 1) return values->second[0];
    if (all.size() == here_.run->simulations.size()) return values->second[index_];
    throw std::runtime_error(
        fmt::format("the run '{}' has {} simulations, and none with these parameters", run, all.size()));
  }

  const std::vector<Solved>& before_;
  const Solved& here_;
  std::size_t index_;
};

double evaluate(const Formula& formula, const Quantities& quantities) {
  try {
    return formula.expression.evaluate(quantities);
  } catch (const std::runtime_error& error) {
    const SourcePosition& where = formula.where;
    throw std::runtime_error(
        fmt::format("{}:{}:{}: {}: {}", where.file, where.line, where.column, formula.key, error.what()));
  }
}

std::optional<double> evaluate(const std::optional<Formula>& formula, const Quantities& quantities) {
  return formula ? std::optional(evaluate(*formula, quantities)) : std::nullopt;
}

// Place of the simulation's order in the list of the run.
std::optional<std::size_t> order_place(const RunSpec& run, const Simulation& simulation) {
  const auto found = std::find(run.orders.begin(), run.orders.end(), simulation.order.value_or(0));
  if (found == run.orders.end()) return std::nullopt;
  return static_cast<std::size_t>(found - run.orders.begin());
}

bool holds(const Row& row) {
  // Nothing is shown by a number that is not finite, on whichever side it stands.
  if (!std::isfinite(row.computed)) return false;
  if (row.at_most) return std::isfinite(*row.at_most) && row.computed <= *row.at_most;
  if (row.at_least) return std::isfinite(*row.at_least) && row.computed >= *row.at_least;
  const double error = std::abs(row.computed - *row.expected);
  const double tolerance =
      row.absolute_tolerance.value_or(row.tolerance.value_or(0.0) * std::abs(*row.expected));
  return std::isfinite(*row.expected) && std::isfinite(tolerance) && error <= tolerance;
}

// The numbers of a row. Throws std::runtime_error when an expression asks for what is not there.
void evaluate(const QuantitySpec& spec, const Quantities& quantities, Row& row) {
  if (spec.expected) row.expected = evaluate(spec.expected, quantities);
  row.at_most = evaluate(spec.at_most, quantities);
  row.at_least = evaluate(spec.at_least, quantities);
  row.tolerance = evaluate(spec.tolerance, quantities);
  row.absolute_tolerance = evaluate(spec.absolute_tolerance, quantities);
  row.computed = evaluate(spec.value, quantities);
  if (row.expected && *row.expected != 0.0) {
    row.relative_error = (row.computed - *row.expected) / std::abs(*row.expected);
  }
}

Row make_row(const QuantitySpec& spec, const SolvedRun& run, std::size_t index,
             const Quantities& quantities) {
  const Simulation& simulation = run.simulations[index];
  const Outcome& outcome = run.outcomes[index];
  Row row;
  row.run = run.spec->name;
  row.quantity = spec.name;
  row.unit = spec.unit;
  row.order = simulation.order;
  if (!row.order && run.spec->builtin.empty() && run.spec->command == RunCommand::run)
    row.order = outcome.order;
  row.parameters = simulation.parameters;
  row.label = simulation.label;
  row.source = spec.source;
  row.wall_time = outcome.wall_time;
  row.failure = outcome.failure;
  row.published = spec.published;
  for (const auto& [numbers, place] : {std::pair(&spec.expected_by_order, order_place(*run.spec, simulation)),
                                       std::pair(&spec.expected_by_point, simulation.point)}) {
    if (place && !numbers->empty()) row.expected = (*numbers)[*place];
  }
  for (const auto& [numbers, place] :
       {std::pair(&spec.published_by_order, order_place(*run.spec, simulation)),
        std::pair(&spec.published_by_point, simulation.point)}) {
    if (place && !numbers->empty() && std::isfinite((*numbers)[*place])) row.published = (*numbers)[*place];
  }
  row.computed = none;
  if (!outcome.failure.empty()) return row;
  try {
    evaluate(spec, quantities, row);
  } catch (const std::runtime_error& error) {
    row.failure = error.what();
  }
  row.pass = row.failure.empty() && holds(row);
  return row;
}

}  // namespace

std::vector<Row> make_rows(const std::vector<SolvedRun>& runs) {
  std::vector<Row> rows;
  std::vector<Solved> solved;
  for (const SolvedRun& run : runs) {
    Solved here{&run, {}};
    for (const QuantitySpec& spec : run.spec->quantities) {
      std::vector<double> values;
      for (std::size_t k = 0; k < run.simulations.size(); ++k) {
        rows.push_back(make_row(spec, run, k, SimulationQuantities(solved, here, k)));
        values.push_back(rows.back().computed);
      }
      here.values[spec.name] = std::move(values);
    }
    solved.push_back(std::move(here));
  }
  return rows;
}

}  // namespace keyblock::verification
