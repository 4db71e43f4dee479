#include "verification/simulate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "core/checked_json.h"
#include "core/error.h"
#include "record/computation_errors.h"
#include "record/energy_warnings.h"
#include "record/record_fields.h"
#include "results/csv.h"
#include "results/summary.h"
#include "scenario/build.h"
#include "scenario/cut_summary.h"
#include "scenario/key_blocks.h"
#include "scenario/key_path.h"
#include "scenario/parse.h"
#include "simulation/run.h"

namespace keyblock::verification {
namespace {

using Numbers = std::map<std::string, double, std::less<>>;

// Digits of a hash that a double holds.
constexpr std::size_t hash_digits = 13;

// Numbers of a JSON value by path: `stages.0.damage.fallen_blocks`.
void flatten(const nlohmann::json& value, const std::string& path, Numbers& numbers) {
  const auto below = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) flatten(member, below(key), numbers);
  } else if (value.is_array()) {
    for (std::size_t k = 0; k < value.size(); ++k) flatten(value[k], below(std::to_string(k)), numbers);
  } else if (value.is_boolean()) {
    numbers[path] = value.get<bool>() ? 1.0 : 0.0;
  } else if (value.is_number()) {
    numbers[path] = value.get<double>();
  } else if (value.is_string() && path == "state_hash") {
    const auto text = value.get<std::string>();
    const std::string digits = text.size() > hash_digits ? text.substr(text.size() - hash_digits) : text;
    numbers[path] = static_cast<double>(std::stoull(digits, nullptr, 16));
  }
}

/// Keeps what quantities may ask for.
class Memory final : public record::RunObserver {
 public:
  explicit Memory(Outcome& outcome) : outcome_(outcome) {}

  void begin(const record::ModelRecord& model) override {
    model_ = model;
    if (!outcome_.columns.empty()) return;  // resumed
    outcome_.columns = results::history_columns(model);
  }
  void history(const record::HistoryRow& row) override {
    outcome_.rows.push_back(results::history_numbers(row));
  }
  void contacts(const record::ContactFrame& frame) override { last_ = frame; }
  void stage_end(int, const record::StageRecord& record) override {
    outcome_.stage_rows[record.stage.name] = outcome_.rows.size();
  }
  void end(const record::RunRecord& run) override {
    outcome_.summary.clear();
    flatten(nlohmann::json::parse(results::summary_json(model_, run)), "", outcome_.summary);
    sum_forces();
  }

 private:
  void sum_forces() {
    outcome_.forces.clear();
    std::map<std::pair<std::string, std::string>, Vec2> shear;
    for (const record::ContactRecord& contact : last_.contacts) {
      std::pair pair(name(contact.block_a), name(contact.block_b));
      Vec2 force = contact.shear_force * perpendicular(contact.normal);
      if (pair.first > pair.second) {
        std::swap(pair.first, pair.second);
        force = -1.0 * force;
      }
      outcome_.forces[pair].normal += contact.normal_force;
      shear[pair] += force;
    }
    for (const auto& [pair, force] : shear) outcome_.forces[pair].shear = norm(force);
  }
  [[nodiscard]] const std::string& name(int block) const {
    return model_.blocks[static_cast<std::size_t>(block)].name;
  }

  Outcome& outcome_;
  record::ModelRecord model_;
  record::ContactFrame last_;
};

/// A folder for checkpoints that goes with its end.
class Scratch {
 public:
  Scratch() {
    std::string path = (std::filesystem::temp_directory_path() / "keyblock-verify-XXXXXX").string();
    if (::mkdtemp(path.data()) == nullptr) throw RunError(path + ": cannot be made");
    path_ = path;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Interrupts a run after a number of steps.
class Interrupter final : public record::RunObserver {
 public:
  explicit Interrupter(long after) : after_(after) {}
  void step(const record::StepRow& row) override { stop = row.step >= after_; }
  std::atomic<bool> stop = false;

 private:
  long after_;
};

void run_engine(const RunSpec& run, const simulation::RunSetup& setup, const std::atomic<bool>* stop,
                Outcome& outcome) {
  Memory memory(outcome);
  simulation::RunOptions options;
  options.stop = stop;
  std::optional<Scratch> scratch;
  if (run.resume_after > 0) {
    scratch.emplace();
    options.directory = scratch->path();
    Interrupter interrupter(run.resume_after);
    options.stop = &interrupter.stop;
    simulation::run(setup, options, interrupter);
    options.stop = stop;
    options.resume = std::filesystem::exists(scratch->path() / "checkpoint.bin");
  }
  const record::RunRecord record = simulation::run(setup, options, memory);
  if (record.interrupted) throw RunError("interrupted");
  record::check_computation(record);
}

// Mean over realizations, and its standard error.
void cut_realizations(const RunSpec& run, const scenario::Scenario& scenario, const std::string& version,
                      Outcome& outcome) {
  const int count = std::max(1, run.realizations);
  std::map<std::string, std::vector<double>, std::less<>> samples;
  for (int realization = 0; realization < count; ++realization) {
    Numbers numbers;
    const scenario::BlockModel model = scenario::build_blocks(scenario, realization);
    if (run.command == RunCommand::census) {
      constexpr double factor = scenario::usual_wanted_factor;
      const census::Census census = scenario::take_census(scenario, model, factor);
      flatten(scenario::census_json(scenario, realization, model, census, factor), "", numbers);
    } else {
      flatten(nlohmann::json::parse(scenario::cut_summary(scenario, realization, model, version)), "",
              numbers);
    }
    for (const auto& [path, number] : numbers) samples[path].push_back(number);
  }
  for (const auto& [path, sample] : samples) {
    const auto n = static_cast<double>(sample.size());
    double mean = 0.0, squares = 0.0;
    for (const double x : sample) mean += x / n;
    for (const double x : sample) squares += (x - mean) * (x - mean);
    outcome.summary[path] = mean;
    if (sample.size() > 1) outcome.standard_error[path] = std::sqrt(squares / (n - 1.0) / n);
  }
}

// The last words of a key path, which tell enough in a table.
std::string short_key(const std::string& key) {
  const auto segments = scenario::parse_key_path(key);
  if (!segments || segments->size() < 2) return key;
  return (*segments)[segments->size() - 2].key + "." + segments->back().key;
}

std::string label_of(const Point& point) {
  if (!point.label.empty()) return point.label;
  std::string label;
  for (const auto& [key, value] : point.parameters) {
    label += fmt::format("{}{} = {}", label.empty() ? "" : ", ", short_key(key), value);
  }
  return label;
}

void append_product(std::vector<Simulation>& all, const std::string& key,
                    const std::vector<std::string>& values) {
  std::vector<Simulation> product;
  for (const Simulation& simulation : all) {
    for (const std::string& value : values) {
      product.push_back(simulation);
      product.back().parameters.emplace_back(key, value);
      product.back().label +=
          fmt::format("{}{} = {}", simulation.label.empty() ? "" : ", ", short_key(key), value);
    }
  }
  all = std::move(product);
}

}  // namespace

std::vector<Simulation> simulations(const RunSpec& run) {
  std::vector<Simulation> all(1);
  if (!run.orders.empty()) {
    all.clear();
    for (const int order : run.orders) all.push_back({{}, order, {}, {}, {}});
  }
  if (!run.points.empty()) {
    std::vector<Simulation> product;
    for (const Simulation& simulation : all) {
      for (std::size_t k = 0; k < run.points.size(); ++k) {
        product.push_back({{}, simulation.order, run.points[k].parameters, k, label_of(run.points[k])});
      }
    }
    all = std::move(product);
  }
  for (const auto& [key, values] : run.vary) append_product(all, key, values);
  for (Simulation& simulation : all) {
    simulation.overrides = run.set;
    if (simulation.order) simulation.overrides.push_back(fmt::format("rock.order={}", *simulation.order));
    for (const auto& [key, value] : simulation.parameters)
      simulation.overrides.push_back(fmt::format("{}={}", key, value));
  }
  return all;
}

Outcome simulate(const RunSpec& run, const Simulation& simulation, const std::string& version,
                 const std::atomic<bool>* stop) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  Outcome outcome;
  try {
    if (!run.builtin.empty()) {
      outcome.results = run_builtin(run.builtin, run.data);
    } else {
      const scenario::Scenario scenario = scenario::parse_scenario(run.scenario, simulation.overrides);
      outcome.order = scenario.rock.order;
      if (outcome.order == scenario::automatic_order) outcome.order.reset();
      if (run.command != RunCommand::run) {
        cut_realizations(run, scenario, version, outcome);
      } else {
        simulation::RunSetup setup = scenario::build_setup(scenario, 0);
        setup.version = version;
        run_engine(run, setup, stop, outcome);
      }
    }
  } catch (const RunError& error) {
    outcome.failure = error.what();
  }
  outcome.wall_time = std::chrono::duration<double>(Clock::now() - start).count();
  return outcome;
}

}  // namespace keyblock::verification
