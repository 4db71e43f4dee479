#include "verification/case_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "block/order.h"
#include "core/atomic_file.h"
#include "scenario/key_path.h"
#include "scenario/override.h"
#include "scenario/table_reader.h"
#include "verification/builtin.h"

namespace keyblock::verification {
namespace {

using scenario::describe;
using scenario::Rule;
using scenario::TableReader;
using scenario::Value;

constexpr scenario::Word<RunCommand> commands[] = {
    {"run", RunCommand::run}, {"cut", RunCommand::cut}, {"census", RunCommand::census}};

// More simulations in one run are a slip of the pen.
constexpr std::size_t most_simulations = 100000;

Rule only(bool applies, std::string_view condition, Rule rule = {}) {
  rule.applies = applies;
  rule.condition = condition;
  return rule;
}

bool formula(TableReader& t, std::string_view key, std::optional<Formula>& formula, const Rule& rule) {
  const Value* value = t.any(key, "number or expression", rule);
  if (value == nullptr) return false;
  Formula read;
  read.where = value->where;
  read.key = scenario::join_path(t.path(), key);
  if (value->is_number()) {
    read.expression = Expression(value->number);
  } else if (value->is(Value::Type::string)) {
    try {
      read.expression = Expression(value->text);
    } catch (const ExpressionError& error) {
      t.fail(key, fmt::format("{} at character {} of the expression", error.found, error.column),
             error.expected);
      return false;
    }
  } else {
    t.fail(key, describe(*value), "a number or an expression in double quotes");
    return false;
  }
  formula = std::move(read);
  return true;
}

// A number for each order, or for each point, of the run.
void number_for_each(TableReader& t, std::string_view key, std::vector<double>& numbers, std::size_t count,
                     std::string_view what) {
  const std::string condition = fmt::format("{} of the run", what);
  const Value* value = t.any(key, "array of numbers", only(count > 0, condition));
  if (value == nullptr) return;
  const bool right =
      value->is(Value::Type::array) && std::all_of(value->items.begin(), value->items.end(),
                                                   [](const Value& item) { return item.is_number(); });
  if (!right || value->items.size() != count) {
    t.fail(key, describe(*value), fmt::format("an array of {} numbers, one for each of the {}", count, what));
    return;
  }
  for (const Value& item : value->items) numbers.push_back(item.number);
}

void check_expectation(TableReader& t, const QuantitySpec& quantity) {
  int kinds = 0;
  for (const char* key : {"expected", "expected_by_order", "expected_by_point", "at_most", "at_least"})
    kinds += t.find(key) != nullptr;
  if (kinds != 1) {
    t.fail("expected", kinds == 0 ? "nothing" : "several of them",
           "one of expected, expected_by_order, expected_by_point, at_most, at_least");
  }
  const bool bound = quantity.at_most || quantity.at_least;
  const int tolerances = (t.find("tolerance") != nullptr) + (t.find("absolute_tolerance") != nullptr);
  if (bound && tolerances > 0) t.fail("tolerance", "a tolerance beside a bound", "the bound alone");
  if (!bound && kinds == 1 && tolerances != 1) {
    t.fail("tolerance", tolerances == 0 ? "nothing" : "both", "either tolerance or absolute_tolerance");
  }
}

void read_quantity(TableReader& t, QuantitySpec& quantity, const RunSpec& run) {
  t.string("name", quantity.name, {.required = true});
  t.string("unit", quantity.unit, {});
  std::optional<Formula> value;
  formula(t, "value", value, {.required = true});
  if (value) quantity.value = *value;
  formula(t, "expected", quantity.expected, {});
  const std::size_t orders = run.orders.size(), points = run.points.size();
  number_for_each(t, "expected_by_order", quantity.expected_by_order, orders, "orders");
  number_for_each(t, "expected_by_point", quantity.expected_by_point, points, "points");
  formula(t, "at_most", quantity.at_most, {});
  formula(t, "at_least", quantity.at_least, {});
  formula(t, "tolerance", quantity.tolerance, {});
  formula(t, "absolute_tolerance", quantity.absolute_tolerance, {});
  t.number("published", quantity.published, {});
  number_for_each(t, "published_by_order", quantity.published_by_order, orders, "orders");
  number_for_each(t, "published_by_point", quantity.published_by_point, points, "points");
  t.string("source", quantity.source, {});
  check_expectation(t, quantity);
}

bool is_array(const Value& value) {
  return value.is(Value::Type::array) && !value.items.empty();
}

void read_strings(TableReader& t, std::string_view key, std::vector<std::string>& strings, const Rule& rule) {
  const Value* value = t.any(key, "array of strings", rule);
  if (value == nullptr) return;
  if (!value->is(Value::Type::array)) {
    t.fail(key, describe(*value), "an array of strings");
    return;
  }
  for (const Value& item : value->items) {
    if (item.is(Value::Type::string)) {
      strings.push_back(item.text);
    } else {
      t.fail_at(item, scenario::join_path(t.path(), key), describe(item), "a string");
    }
  }
}

void read_orders(TableReader& t, std::vector<int>& orders, const Rule& rule) {
  const Value* value = t.any("orders", "array of integers", rule);
  if (value == nullptr) return;
  const auto is_order = [](const Value& item) {
    return item.is(Value::Type::integer) && item.integer >= 1 && item.integer <= block::highest_order;
  };
  if (!is_array(*value) || !std::all_of(value->items.begin(), value->items.end(), is_order)) {
    t.fail("orders", describe(*value),
           fmt::format("an array of integers from 1 to {}", block::highest_order));
    return;
  }
  for (const Value& item : value->items) orders.push_back(static_cast<int>(item.integer));
}

void read_vary(TableReader& t, RunSpec& run, const Rule& rule) {
  const Value* value = t.any("vary", "table of arrays", rule);
  if (value == nullptr) return;
  if (!value->is(Value::Type::table)) {
    t.fail("vary", describe(*value), "a table: \"key path\" = [values]");
    return;
  }
  for (const Value& axis : value->items) {
    if (!is_array(axis)) {
      t.fail_at(axis, scenario::join_path(t.path(), "vary"), describe(axis), "an array of values");
      continue;
    }
    std::vector<std::string> values;
    for (const Value& item : axis.items) values.push_back(to_toml(item));
    run.vary.emplace_back(axis.key, std::move(values));
  }
}

void read_points(TableReader& t, RunSpec& run, const Rule& rule) {
  t.table("points", rule, [&](TableReader& p) {
    std::vector<std::string> keys;
    read_strings(p, "keys", keys, {.required = true});
    std::vector<std::string> labels;
    read_strings(p, "labels", labels, {});
    const Value* values = p.any("values", "array of arrays", {.required = true});
    if (values == nullptr || keys.empty()) return;
    if (!is_array(*values)) {
      p.fail("values", describe(*values), "an array of arrays, one for each simulation");
      return;
    }
    for (const Value& tuple : values->items) {
      if (!tuple.is(Value::Type::array) || tuple.items.size() != keys.size()) {
        p.fail_at(tuple, scenario::join_path(p.path(), "values"), describe(tuple),
                  fmt::format("an array of {}, a value for each key", keys.size()));
        continue;
      }
      Point point;
      for (std::size_t k = 0; k < keys.size(); ++k)
        point.parameters.emplace_back(keys[k], to_toml(tuple.items[k]));
      run.points.push_back(std::move(point));
    }
    if (labels.empty()) return;
    if (labels.size() != run.points.size()) {
      p.fail("labels", fmt::format("{} of them", labels.size()),
             fmt::format("one for each of the {} values", run.points.size()));
      return;
    }
    for (std::size_t k = 0; k < labels.size(); ++k) run.points[k].label = labels[k];
  });
}

void check_size(TableReader& t, const RunSpec& run) {
  std::size_t count =
      std::max<std::size_t>(1, run.orders.size()) * std::max<std::size_t>(1, run.points.size());
  for (const auto& axis : run.vary) count *= axis.second.size();
  if (count > most_simulations) {
    t.fail("vary", fmt::format("{} simulations", count), fmt::format("at most {}", most_simulations));
  }
}

void read_run(TableReader& t, RunSpec& run) {
  t.name("name", run.name, "run", {.required = true});
  t.boolean("long", run.is_long, {});
  const bool builtin = t.find("builtin") != nullptr;
  t.string("builtin", run.builtin, {});
  if (builtin && !is_builtin(run.builtin)) {
    t.fail("builtin", '"' + run.builtin + '"', scenario::list_words(builtin_names()),
           scenario::suggestion(run.builtin, builtin_names()));
  }
  std::vector<std::string> data;
  read_strings(t, "data", data, only(builtin, "builtin"));
  for (const std::string& file : data) {
    run.data.push_back(t.context().directory / file);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(run.data.back(), ignored)) {
      t.fail("data", '"' + file + '"', "a file that exists", "paths are relative to the case file");
    }
  }
  const auto simulated = [&](Rule rule = {}) { return only(!builtin, "a scenario", rule); };
  t.file("scenario", run.scenario, simulated({.required = true}));
  t.word("command", run.command, commands, simulated());
  read_strings(t, "set", run.set, simulated());
  read_orders(t, run.orders, simulated());
  read_vary(t, run, simulated());
  read_points(t, run, simulated());
  const bool cut = run.command != RunCommand::run;
  t.integer("realizations", run.realizations,
            only(!builtin && cut, "command = \"cut\" or \"census\"", {.at_least = 2.0}));
  int steps = 0;
  t.integer("resume_after", steps, only(!builtin && !cut, "command = \"run\"", {.at_least = 1.0}));
  run.resume_after = steps;
  check_size(t, run);
  t.tables("quantity", run.quantities, {.required = true},
           [&](TableReader& q, QuantitySpec& quantity) { read_quantity(q, quantity, run); });
}

}  // namespace

CaseFile read_case(const std::filesystem::path& file) {
  const Value document = scenario::parse_toml(read_file(file, scenario::largest_scenario), file.string());
  scenario::ReadContext context;
  context.directory = file.parent_path();
  TableReader root(context, &document);
  CaseFile result;
  result.name = file.stem().string();
  root.string("title", result.title, {.required = true});
  root.integer("case", result.number, {.required = true, .at_least = 1.0});
  root.string("about", result.about, {});
  root.boolean("long", result.is_long, {});
  root.tables("run", result.runs, {.required = true}, [](TableReader& t, RunSpec& run) { read_run(t, run); });
  root.finish();
  if (!context.mistakes.empty()) throw context.mistakes.error();
  return result;
}

std::vector<CaseFile> read_cases(const std::filesystem::path& folder) {
  std::vector<CaseFile> cases;
  std::vector<Diagnostic> mistakes;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".toml") continue;
    try {
      cases.push_back(read_case(entry.path()));
    } catch (const InputError& input_error) {
      mistakes.insert(mistakes.end(), input_error.diagnostics().begin(), input_error.diagnostics().end());
    }
  }
  if (error || (cases.empty() && mistakes.empty())) {
    Diagnostic diagnostic;
    diagnostic.where.file = folder.string();
    diagnostic.found = error ? error.message() : std::string("no case");
    diagnostic.expected = "a folder of case files (*.toml)";
    mistakes.push_back(std::move(diagnostic));
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  std::sort(cases.begin(), cases.end(), [](const CaseFile& a, const CaseFile& b) {
    return std::tie(a.number, a.name) < std::tie(b.number, b.name);
  });
  return cases;
}

}  // namespace keyblock::verification
