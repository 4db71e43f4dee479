#include "study/limit_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "record/damage_fields.h"
#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario/key_path.h"
#include "scenario/key_reference.h"
#include "scenario/parse.h"
#include "study/folder.h"
#include "study/refusal.h"
#include "study/variant.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;

constexpr double largest_tolerance = 0.5;
constexpr int most_scanned = 1000;  // parts

// As TOML, with a point or an exponent: what must be an integer is no key for a bisection.
std::string value_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

scenario::Scenario scenario_at(const Plan& plan, const LimitRequest& request, double value) {
  std::vector<std::string> overrides = plan.overrides;
  overrides.push_back(request.key + "=" + value_text(value));
  return scenario::parse_scenario_text(plan.text, plan.scenario, overrides, scenario::StudyTable::leave_out);
}

/// What is odd at both ends of the search is so all over it; the rest belongs to the run in question. Throws InputError where an end is wrong.
std::vector<std::string> warnings_of_ends(const Plan& plan, const LimitRequest& request) {
  const auto warnings_at = [&](double end) {
    return scenario::check_inputs(scenario_at(plan, request, end));
  };
  std::vector<std::string> of_both = warnings_at(request.from);
  const std::vector<std::string> of_other = warnings_at(request.to);
  std::erase_if(of_both, [&](const std::string& warning) {
    return std::ranges::find(of_other, warning) == of_other.end();
  });
  return of_both;
}

void check_request(const LimitRequest& request) {
  for (const auto& [option, value] : {std::pair{"--from", request.from}, std::pair{"--to", request.to}}) {
    if (!std::isfinite(value)) refuse(option, fmt::format("{}", value), "a number");
  }
  if (request.from == request.to)
    refuse("--to", fmt::format("{}, as --from", request.to), "another value than --from");
  if (request.scan < 0 || request.scan > most_scanned)
    refuse("--scan", fmt::format("{}", request.scan), fmt::format("1 to {} parts", most_scanned));
  if (!(request.tolerance > 0.0 && request.tolerance <= largest_tolerance))
    refuse("--tolerance", fmt::format("{}", request.tolerance),
           fmt::format("above 0, at most {}", largest_tolerance));
}

/// A stage before the last one.
void check_since(const LimitRequest& request, std::span<const simulation::Stage> stages) {
  if (request.since.empty()) return;
  if (request.criterion.by_standing)
    refuse("--since", '"' + request.since + '"',
           "nothing, as " + request.criterion.name + " is how the blocks are at the end");
  std::vector<std::string> earlier;
  for (std::size_t k = 0; k + 1 < stages.size(); ++k) earlier.push_back(stages[k].name);
  if (std::ranges::find(earlier, request.since) != earlier.end()) return;
  refuse("--since", '"' + request.since + '"',
         earlier.empty() ? "nothing, as there is no stage before the last one"
                         : "a stage before the last one: " + scenario::list_words(earlier),
         scenario::suggestion(request.since, earlier));
}

/// A measure of elements is not known where none has a limit: it would never be above anything.
void check_measure(const LimitRequest& request, const scenario::Scenario& scenario) {
  const auto yields = [](const loading::Spring& spring) { return spring.yield.has_value(); };
  if (std::ranges::any_of(scenario.springs, yields)) return;
  simulation::for_damage_fields([&](const auto& field) {
    if (request.criterion.measure == field.name && field.column.table == simulation::DamageTable::elements)
      refuse("--until", '"' + request.criterion.measure + '"',
             "a measure that the scenario has: no [[spring]] has a yield");
  });
}

class Search {
 public:
  Search(const fs::path& directory, Plan plan, LimitResult& result, const LimitOptions& options)
      : directory_(directory),
        plan_(std::move(plan)),
        result_(result),
        options_(options),
        bisection_(result.request.from, result.request.to, result.request.tolerance, result.request.scan) {
    for (PlannedRun& run : plan_.runs) run.wanted = false;
    for (int k = 0; k < result.request.realizations; ++k) result_.realizations.push_back({k, {}, {}, {}});
    told_.resize(result_.realizations.size());
    second_.resize(result_.realizations.size());
  }

  /// Whether it came to its end.
  bool run() {
    while (true) {
      update();
      const std::vector<PlannedRun> round = next_round();
      if (round.empty()) return true;
      if (options_.workers.stop != nullptr && options_.workers.stop->load()) return false;
      if (run_round(round)) continue;
      update();  // by the runs that had ended
      return false;
    }
  }

  /// Of one realization.
  HoldMap holds() {
    std::vector<std::pair<double, const std::vector<simulation::BlockStatus>*>> trials;
    if (result_.realizations.size() > 1) return {};
    for (const LimitTrial& trial : result_.realizations.front().trials)
      trials.emplace_back(
          trial.value, &state_of(planned(result_.realizations.front().realization, trial.value)).result.map);
    return hold_map(plan_.grid, plan_.outlines, result_.request.from, std::move(trials));
  }

 private:
  static bool searching(const RealizationLimit& limit) {
    return limit.error.empty() && limit.state.status == Bisection::Status::open;
  }

  PlannedRun planned(int realization, double value) const {
    const std::string text = value_text(value);
    const std::string variant = result_.request.has_rest ? still_variant : "";
    return {run_key(realization, {result_.request.key + "=" + text}, variant),
            realization,
            {{text}},
            variant,
            true};
  }

  // What is known of a run that a trial is: read once.
  const RunState& state_of(const PlannedRun& run) {
    const auto known = states_.find(run.key);
    if (known != states_.end()) return known->second;
    return states_.emplace(run.key, read_run_state(directory_, plan_, run)).first->second;
  }

  Known known(int realization) {
    return [this, realization](double value) -> std::optional<bool> {
      const RunState& state = state_of(planned(realization, value));
      if (state.kind != RunState::Kind::done) return std::nullopt;
      return limit_trial(result_.request, value, state.result).met;
    };
  }

  void update() {
    for (std::size_t k = 0; k < result_.realizations.size(); ++k) {
      RealizationLimit& limit = result_.realizations[k];
      limit.state = bisection_.follow(known(limit.realization));
      limit.trials.clear();
      for (const double value : limit.state.path)
        limit.trials.push_back(
            limit_trial(result_.request, value, state_of(planned(limit.realization, value)).result));
      for (const LimitTrial& trial : limit.trials)
        if (told_[k].insert(trial.value).second) options_.trial(limit, trial);
      result_.request.criterion.has_two_ends() ? look_for_falling(k) : look_for_moving(k);
    }
  }

  LimitTrial trial_of(int realization, double value) {
    return limit_trial(result_.request, value, state_of(planned(realization, value)).result);
  }

  Known known_to_go(int realization) {
    return [this, realization](double value) -> std::optional<bool> {
      if (state_of(planned(realization, value)).kind != RunState::Kind::done) return std::nullopt;
      return trial_of(realization, value).goes();
    };
  }

  /// Of a search that has ended: which trial goes though the criterion does not hold, and from where on they do.
  void look_for_moving(std::size_t k) {
    RealizationLimit& limit = result_.realizations[k];
    const double from = result_.request.from;
    if (searching(limit)) return;
    for (const LimitTrial& trial : limit.trials) {
      const bool is_nearer =
          !limit.moves || std::abs(trial.value - from) < std::abs(limit.moves->value - from);
      if (!trial.met && trial.goes() && is_nearer) limit.moves = trial;
    }
    if (!limit.moves || limit.moves->value == from || !result_.request.finds_moving) return;
    if (!second_[k]) second_[k].emplace(from, limit.moves->value, result_.request.tolerance);
    const Bisection::State state = second_[k]->follow(known_to_go(limit.realization));
    if (state.status == Bisection::Status::found) limit.moves = trial_of(limit.realization, state.met);
  }

  /// Of a search that has found where rock moves: from where on blocks do not stand.
  void look_for_falling(std::size_t k) {
    RealizationLimit& limit = result_.realizations[k];
    if (!limit.found()) return;
    const double from = result_.request.from;
    const LimitTrial* first = nullptr;
    for (const LimitTrial& trial : limit.trials) {
      const bool is_nearer = first == nullptr || std::abs(trial.value - from) < std::abs(first->value - from);
      if (trial.goes() && is_nearer) first = &trial;
    }
    if (first == nullptr) return;
    limit.falls = *first;
    limit.stands_to = limit.state.not_met;
    if (first->value == limit.state.met) return;
    if (!second_[k]) second_[k].emplace(limit.state.not_met, first->value, result_.request.tolerance);
    const Bisection::State state = second_[k]->follow(known_to_go(limit.realization));
    if (state.status != Bisection::Status::found) return;
    limit.falls = trial_of(limit.realization, state.met);
    limit.stands_to = state.not_met;
  }

  /// What is to be run of a realization.
  Bisection::Next next_of(std::size_t k, std::size_t workers) {
    const RealizationLimit& limit = result_.realizations[k];
    if (searching(limit)) return bisection_.next(known(limit.realization), workers);
    return second_[k] && limit.error.empty() ? second_[k]->next(known_to_go(limit.realization), workers)
                                             : Bisection::Next{};
  }

  std::vector<PlannedRun> next_round() {
    std::vector<PlannedRun> needed, ahead;
    const auto workers = static_cast<std::size_t>(std::max(options_.workers.workers, 1));
    for (std::size_t k = 0; k < result_.realizations.size(); ++k) {
      const Bisection::Next next = next_of(k, workers);
      for (std::size_t n = 0; n < next.values.size(); ++n)
        (n < next.needed ? needed : ahead)
            .push_back(planned(result_.realizations[k].realization, next.values[n]));
    }
    for (const PlannedRun& run : ahead) {
      if (needed.empty() || needed.size() >= workers) break;
      if (state_of(run).kind == RunState::Kind::failed) continue;
      needed.push_back(run);
    }
    return needed;
  }

  // False: interrupted.
  bool run_round(const std::vector<PlannedRun>& round) {
    for (PlannedRun& run : plan_.runs) run.wanted = false;
    for (const PlannedRun& run : round) {
      const auto there = std::find_if(plan_.runs.begin(), plan_.runs.end(),
                                      [&](const PlannedRun& known) { return known.key == run.key; });
      if (there == plan_.runs.end()) {
        plan_.runs.push_back(run);
      } else {
        *there = run;
      }
    }
    write_plan(directory_, plan_);
    StudyFiles files = read_study_files(directory_, plan_);
    const WorkerOutcome outcome = run_workers(directory_, plan_, files, options_.workers);
    for (std::size_t k = 0; k < plan_.runs.size(); ++k) {
      if (plan_.runs[k].wanted) states_[plan_.runs[k].key] = std::move(files.states[k]);
    }
    if (!outcome.interrupted) note_failures(round);
    return !outcome.interrupted;
  }

  // Of the trials that were needed; others are not missed.
  void note_failures(const std::vector<PlannedRun>& round) {
    for (const PlannedRun& run : round) {
      const RunState& state = states_.at(run.key);
      RealizationLimit& limit = result_.realizations[static_cast<std::size_t>(run.realization)];
      if (state.kind == RunState::Kind::done || !limit.error.empty()) continue;
      const Bisection::Next next = next_of(static_cast<std::size_t>(run.realization), 0);
      const auto is_this = [&](double value) { return planned(run.realization, value).key == run.key; };
      if (std::none_of(next.values.begin(), next.values.end(), is_this)) continue;
      if (!searching(limit)) {  // what is told beside the limit is not worth its loss
        second_[static_cast<std::size_t>(run.realization)].reset();
        result_.request.finds_moving = false;
        continue;
      }
      limit.error =
          fmt::format("{} = {} ({}): {}", result_.request.key, run.values[0][0], run.key, state.problem);
    }
  }

  const fs::path& directory_;
  Plan plan_;
  LimitResult& result_;
  const LimitOptions& options_;
  Bisection bisection_;
  std::map<std::string, RunState> states_;
  std::vector<std::set<double>> told_;            // values of trials, of every realization
  std::vector<std::optional<Bisection>> second_;  // for blocks that move before, likewise
};

LimitResult empty_limit(const Plan& plan, const LimitRequest& request) {
  LimitResult result;
  result.title = plan.title;
  result.scenario = plan.scenario.filename().string();
  result.version = plan.version;
  result.seed = plan.seed;
  result.overrides = plan.overrides;
  result.request = request;
  result.unit = scenario::key_unit(request.key);
  for (const scenario::GroundFact& fact : plan.ground) result.ground.emplace_back(fact.name, fact.value);
  result.warnings = plan.warnings;
  result.confidence = plan.confidence;
  return result;
}

/// Of the factor of safety: nothing may give way, or no more than an area.
LimitCriterion criterion_of_safety(const scenario::SafetySpec& safety) {
  const bool has_area = safety.area > 0.0;
  LimitCriterion criterion = has_area ? limit_criterion("moving_area_m2", safety.area, 0.0)
                                      : limit_criterion("gives_way", safety.moved, 0.0);
  criterion.why =
      has_area ? "so much rock may move by [safety] area, in motion, after strength was reduced"
               : "rock has given way that has moved since strength was reduced, or that does not stand";
  return criterion;
}

/// Whose strength is reduced, from when on, and what of the scenario does not come.
std::string what_is_reduced(const scenario::Scenario& scenario) {
  const scenario::SafetySpec& safety = scenario.safety.value();
  std::string text = fmt::format(
      "strength of {} is reduced from the end of \"{}\" on",
      safety.sets.empty() ? "all joints" : scenario::list_words(safety.sets, " and "), safety.stage);
  std::vector<std::string> names;
  for (const simulation::Stage& stage : scenario.left_out) names.push_back(stage.name);
  if (!names.empty())
    text += fmt::format("; not run, with what {}: {}", names.size() == 1 ? "it does" : "they do",
                        scenario::list_words(names, " and "));
  return text;
}

/// That which is asked for, or else that of the key or of the model.
LimitCriterion chosen_criterion(const scenario::Scenario& scenario, const std::string& key,
                                const std::string& until, std::optional<double> above) {
  const double loosened = scenario.damage.loosened_distance;
  if (!until.empty()) return limit_criterion(until, above, loosened);
  if (key == safety_key) {
    if (above)
      refuse("--above", fmt::format("{}", *above), "nothing, as [safety] moved and area are the thresholds");
    return criterion_of_safety(scenario.safety.value());
  }
  const LimitDefault& row = limit_default(scenario);
  LimitCriterion criterion = limit_criterion(row.criterion, above, loosened);
  criterion.why = fmt::format("--until {} is the default for {}: {}", row.criterion, row.what, row.why);
  return criterion;
}

}  // namespace

Plan plan_limit(const ScenarioText& scenario, const std::string& version, LimitRequest& request,
                const std::string& until, std::optional<double> above) {
  check_request(request);
  std::vector<std::string> warnings;
  Plan plan = make_plan(scenario, version, &warnings);
  const scenario::Scenario read = scenario_at(plan, request, request.from);
  request.criterion = chosen_criterion(read, request.key, until, above);
  check_measure(request, read);
  if (request.key == safety_key) {
    request.of = scenario::list_words(read.safety.value().sets, " and ");
    request.criterion.why += (request.criterion.why.empty() ? "" : "\n") + what_is_reduced(read);
  }
  request.has_rest = needs_rest(request.criterion, read);
  request.finds_moving =
      !request.criterion.by_standing && std::string_view(limit_default(read).criterion) != "fallen";
  if (request.scan == 0) request.scan = scan_of(request.key);
  if (request.realizations > 1 && read.joint_sets.empty())
    warnings.push_back(
        fmt::format("--realizations {}: nothing is random without a [[joint_set]]; all limits are the same, "
                    "and their interval says nothing",
                    request.realizations));
  check_since(request, read.stages);
  for (std::string& warning : warnings_of_ends(plan, request)) {
    if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(std::move(warning));
  }
  // What shows only when blocks are cut and built.
  for (std::string& warning : scenario::build_setup(read, 0).warnings) {
    if (std::ranges::find(warnings, warning) == warnings.end()) warnings.push_back(std::move(warning));
  }
  plan.warnings = std::move(warnings);
  plan.realizations = request.realizations;
  plan.axes = {{{request.key}, {}}};
  plan.since.clear();
  plan.before_shaking.clear();
  plan.levels.clear();
  plan.marginal.reset();
  plan.until.reset();
  plan.runs.clear();
  return plan;
}

LimitResult find_limit(const fs::path& directory, Plan plan, const LimitRequest& request,
                       const LimitOptions& options, bool& interrupted) {
  LimitResult result = empty_limit(plan, request);
  enter_limit(directory, plan, options.resume, limit_json(result));
  Search search(directory, std::move(plan), result, options);
  interrupted = !search.run();
  result.complete = !interrupted;
  write_file_atomically(limit_path(directory), limit_json(result));
  write_file_atomically(directory / "limits.csv", limit_csv(result));
  const HoldMap map = search.holds();
  if (!map.empty()) write_file_atomically(directory / "map.csv", hold_map_csv(map));
  write_file_atomically(directory / "report.html", limit_page(directory, result, map));
  return result;
}

}  // namespace keyblock::study
