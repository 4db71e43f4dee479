#include "study/collect.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "study/findings.h"
#include "study/outputs.h"
#include "study/plan_json.h"
#include "study/until.h"

namespace keyblock::study {
namespace {

namespace fs = std::filesystem;

// Places of runs by realization, then combination, then variant, in the orders of the axes.
std::vector<std::size_t> sorted_places(const Plan& plan) {
  using Rank = std::tuple<int, std::vector<std::size_t>, std::size_t>;
  static const std::vector<std::string> variants{"", "friction-", "friction+", "released", unshaken_variant};
  const auto rank = [&](const PlannedRun& run) {
    std::vector<std::size_t> combination;
    for (std::size_t a = 0; a < std::min(plan.axes.size(), run.values.size()); ++a) {
      const auto& values = plan.axes[a].values;
      combination.push_back(
          static_cast<std::size_t>(std::find(values.begin(), values.end(), run.values[a]) - values.begin()));
    }
    const auto variant = std::find(variants.begin(), variants.end(), run.variant) - variants.begin();
    return Rank{run.realization, std::move(combination), static_cast<std::size_t>(variant)};
  };
  std::vector<std::pair<Rank, std::size_t>> ranked;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) ranked.emplace_back(rank(plan.runs[k]), k);
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::size_t> places;
  for (const auto& [r, k] : ranked) places.push_back(k);
  return places;
}

std::vector<std::string> planned_variants(const Plan& plan) {
  std::vector<std::string> found;
  for (const PlannedRun& run : plan.runs) {
    if (run.wanted && !run.variant.empty() && run.variant != unshaken_variant &&
        std::find(found.begin(), found.end(), run.variant) == found.end())
      found.push_back(run.variant);
  }
  return found;
}

// In the places of the plan; null: missing.
std::vector<const RunResult*> known_results(const StudyFiles& files) {
  std::vector<const RunResult*> results;
  for (const RunState& state : files.states) {
    const bool known = state.kind == RunState::Kind::done || state.kind == RunState::Kind::failed;
    results.push_back(known ? &state.result : nullptr);
  }
  return results;
}

}  // namespace

StudyFiles read_study_files(const fs::path& directory, const Plan& plan, int realizations) {
  StudyFiles files;
  files.states.resize(plan.runs.size());
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (plan.runs[k].wanted && plan.runs[k].realization < realizations)
      files.states[k] = read_run_state(directory, plan, plan.runs[k]);
  }
  update_enough(plan, files);
  return files;
}

void update_enough(const Plan& plan, StudyFiles& files) {
  if (plan.until) files.enough = enough_realizations(plan, known_results(files));
}

void forget_failures(const fs::path& directory, const Plan& plan, StudyFiles& files) {
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (!plan.runs[k].wanted || files.states[k].kind != RunState::Kind::failed) continue;
    remove_failure(directory, plan.runs[k]);
    files.states[k] = {};
  }
  update_enough(plan, files);
}

StudyData study_data(const Plan& plan, StudyFiles files) {
  StudyData study;
  study.title = plan.title;
  study.seed = plan.seed;
  study.version = plan.version;
  for (const scenario::VarySpec& axis : plan.axes) {
    study.axes.push_back({axis.key_text(), {}, axis.keys});
    for (std::size_t k = 0; k < axis.values.size(); ++k)
      study.axes.back().values.push_back(axis.value_text(k));
  }
  study.stage = plan.stage;
  study.since = plan.since;
  study.before = plan.since.empty() ? plan.before_shaking : plan.since;
  study.at_shaking = !study.before.empty() && study.before == plan.before_shaking;
  study.levels = plan.levels;
  study.marginal = plan.marginal;
  study.confidence = plan.confidence;
  study.variants = planned_variants(plan);
  if (plan.until) {
    study.precision = Precision{plan.until->measure, plan.until->half_width, plan.until->width,
                                plan.until->minimum, files.enough.has_value()};
  }
  study.grid = plan.grid;
  study.outlines = plan.outlines;
  for (const scenario::GroundFact& fact : plan.ground) study.ground.emplace_back(fact.name, fact.value);
  study.control = plan.control;
  std::vector<std::ptrdiff_t> place(plan.runs.size(), -1);  // in study.runs
  std::vector<std::size_t> taken;                           // places in the plan
  for (const std::size_t k : sorted_places(plan)) {
    if (!files.asked(plan.runs[k])) continue;
    ++study.planned;
    RunState& state = files.states[k];
    if (state.kind != RunState::Kind::done && state.kind != RunState::Kind::failed) continue;
    place[k] = static_cast<std::ptrdiff_t>(study.runs.size());
    taken.push_back(k);
    study.runs.push_back(std::move(state.result));
  }
  if (!plan.control) return study;
  const std::vector<std::ptrdiff_t> controls = control_places(plan);
  for (const std::size_t k : taken)
    study.control_of.push_back(controls[k] < 0 ? -1 : place[static_cast<std::size_t>(controls[k])]);
  return study;
}

CollectReport collect(const fs::path& directory) {
  check_is_no_limit(directory);
  const Plan plan = read_plan(directory);
  return gather(directory, plan, read_study_files(directory, plan));
}

StudyCount count_runs(const Plan& plan, const StudyFiles& files) {
  StudyCount count;
  count.enough = files.enough;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (!files.asked(plan.runs[k])) continue;
    ++count.asked;
    const RunState& state = files.states[k];
    switch (state.kind) {
      case RunState::Kind::done:
        ++count.done;
        break;
      case RunState::Kind::missing:
        count.missing.push_back(plan.runs[k].key);
        break;
      case RunState::Kind::failed:
        count.failed.push_back(plan.runs[k].key + ": " + state.problem);
        break;
      case RunState::Kind::damaged:
        count.damaged.push_back(state.problem);
        break;
    }
  }
  if (!files.enough) count.lacking = lacking_precision(plan, known_results(files));
  return count;
}

CollectReport gather(const fs::path& directory, const Plan& plan, StudyFiles files) {
  CollectReport report{.count = count_runs(plan, files), .findings = {}};
  const StudyData study = study_data(plan, std::move(files));
  report.findings = findings(study, write_outputs(directory, study));
  return report;
}

}  // namespace keyblock::study
