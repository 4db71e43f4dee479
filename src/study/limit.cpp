#include "study/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/key_path.h"
#include "simulation/damage_fields.h"
#include "simulation/standing.h"
#include "statistics/bootstrap.h"
#include "statistics/sample.h"
#include "study/measures.h"
#include "study/refusal.h"

namespace keyblock::study {
namespace {

using Status = Bisection::Status;

constexpr std::size_t most_lines = 20;  // of realizations, in the text

std::string realization_text(const LimitResult& result, const RealizationLimit& limit) {
  const LimitRequest& request = result.request;
  if (!limit.error.empty()) return "a trial failed: " + limit.error;
  switch (limit.state.status) {
    case Status::found:
      return fmt::format("limit {:.5g}: not met at {:.6g}, met at {:.6g} ({} runs)", limit.limit(),
                         limit.state.not_met, limit.state.met, limit.trials.size());
    case Status::met_at_both:
      return fmt::format("met at --from {:.6g} already", request.from);
    case Status::met_at_none:
      return fmt::format("not met up to --to {:.6g}", request.to);
    case Status::ends_swapped:
      return fmt::format("met at --from {:.6g}, not at --to {:.6g}", request.from, request.to);
    case Status::open:
      break;
  }
  return fmt::format("between {:.6g} and {:.6g} so far", limit.state.not_met, limit.state.met);
}

}  // namespace

std::string LimitCriterion::text() const {
  const Measure& m = measures()[find_measure(measure).value()];
  if (collapse) return "blocks that do not stand";
  return fmt::format("{} of more than {:.6g}{}{}", m.title, above, m.unit.empty() ? "" : " ", m.unit);
}

LimitCriterion limit_criterion(const std::string& name, std::optional<double> above, double loosened) {
  LimitCriterion criterion{name, name, above.value_or(0.0), false};
  if (name == "fallen") {
    criterion.measure = "fallen_area_m2";
  } else if (name == "moved") {
    criterion.measure = "displacement_max_m";
    criterion.above = above.value_or(loosened);
  } else if (name == "collapsed") {
    criterion.measure = "displacement_max_m";
    criterion.collapse = true;
    if (above) refuse("--above", fmt::format("{}", *above), "nothing, as collapsed has no threshold");
  } else if (!find_measure(name)) {
    std::vector<std::string> words{"fallen", "moved", "collapsed"};
    for (const Measure& m : measures()) words.push_back(m.name);
    const std::string hint = scenario::suggestion(name, words);
    refuse("--until", '"' + name + '"', "fallen, moved, collapsed or a measure of summary.json", hint);
  }
  if (!std::isfinite(criterion.above)) refuse("--above", fmt::format("{}", criterion.above), "a number");
  return criterion;
}

const LimitTrial* RealizationLimit::trial_at(double value) const {
  const auto found = std::find_if(trials.begin(), trials.end(),
                                  [&](const LimitTrial& trial) { return trial.value == value; });
  return found == trials.end() ? nullptr : &*found;
}

statistics::Estimate LimitResult::median() const {
  std::vector<double> limits;
  for (const RealizationLimit& limit : realizations) {
    if (limit.found()) limits.push_back(limit.limit());
    if (!limit.error.empty()) continue;
    if (limit.state.status == Status::met_at_both) limits.push_back(request.from);
    if (limit.state.status == Status::met_at_none) limits.push_back(request.to);
  }
  if (limits.empty()) return {};
  std::sort(limits.begin(), limits.end());
  const double half = 0.5;
  return statistics::describe(limits, {&half, 1}, statistics::Resamples(limits.size()), confidence)
      .quantiles.front();
}

LimitTrial limit_trial(const LimitCriterion& criterion, double value, const RunResult& run) {
  const StageMeasures& last = run.stages.at(run.stages.size() - 1);
  LimitTrial trial{value,         run.key, simulation::damage_value(last.damage, criterion.measure),
                   last.standing, false,   run.state_hash};
  trial.met =
      criterion.collapse ? last.standing != simulation::Standing::stands : trial.measure > criterion.above;
  return trial;
}

std::string limit_text(const LimitResult& result) {
  const LimitRequest& request = result.request;
  std::string text = fmt::format("{} until {}\n", request.key, request.criterion.text());
  const auto& all = result.realizations;
  for (std::size_t k = 0; k < std::min(all.size(), most_lines); ++k) {
    const std::string which = all.size() == 1 ? "" : fmt::format("realization {}: ", all[k].realization);
    text += which + realization_text(result, all[k]) + "\n";
  }
  if (all.size() > most_lines) text += fmt::format("and {} realizations more\n", all.size() - most_lines);
  if (all.size() < 2 || !result.complete) return text;
  const statistics::Estimate median = result.median();
  const auto found = std::count_if(all.begin(), all.end(), [](const auto& limit) { return limit.found(); });
  text += fmt::format("limits of {} of {} realizations", found, all.size());
  if (std::isfinite(median.value)) text += fmt::format(": median {:.5g}", median.value);
  if (std::isfinite(median.low))
    text += fmt::format(" ({:.0f} % interval {:.5g} … {:.5g})", 100.0 * result.confidence, median.low,
                        median.high);
  return text + "\n";
}

}  // namespace keyblock::study
