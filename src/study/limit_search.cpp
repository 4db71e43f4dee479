#include "study/limit_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"
#include "scenario/key_path.h"
#include "scenario/key_reference.h"
#include "study/folder.h"
#include "study/limit_statistics.h"
#include "study/variant.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;

class Search {
 public:
  Search(const fs::path& directory, Plan plan, LimitResult& result, const LimitOptions& options)
      : directory_(directory),
        plan_(std::move(plan)),
        result_(result),
        options_(options),
        bisection_(result.request.from, result.request.to, result.request.tolerance, result.request.scan,
                   result.request.decided_value()) {
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
    std::vector<std::pair<double, const std::vector<record::BlockStatus>*>> trials;
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
    const std::string text = limit_value_text(value);
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
      if (!limit.trials.empty())
        limit.strengths = state_of(planned(limit.realization, limit.trials.front().value)).result.strengths;
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

}  // namespace

LimitResult find_limit(const fs::path& directory, Plan plan, const LimitRequest& request,
                       const LimitOptions& options, bool& interrupted) {
  LimitResult result = empty_limit(plan, request);
  enter_limit(directory, plan, options.resume, limit_json(result));
  Search search(directory, std::move(plan), result, options);
  interrupted = !search.run();
  result.complete = !interrupted;
  write_file_atomically(limit_path(directory), limit_json(result));
  write_file_atomically(directory / "limits.csv", limit_csv(result));
  if (result.realizations.size() > 1)
    write_file_atomically(directory / "statistics.csv", statistics_csv(result));
  const HoldMap map = search.holds();
  if (!map.empty()) write_file_atomically(directory / "map.csv", hold_map_csv(map));
  write_file_atomically(directory / "report.html", limit_page(directory, result, map));
  return result;
}

}  // namespace keyblock::study
