#include "study/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/key_path.h"
#include "simulation/damage_fields.h"
#include "simulation/standing.h"
#include "statistics/order_statistics.h"
#include "statistics/proportion.h"
#include "statistics/sample.h"
#include "study/measures.h"
#include "study/refusal.h"

namespace keyblock::study {
namespace {

using Status = Bisection::Status;

constexpr std::size_t most_lines = 20;  // of realizations, in the text
constexpr double limit_quantiles[] = {0.05, 0.25, 0.5, 0.75, 0.95};

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

/// "limits of 18 of 20 realizations: median 5.1 (95 % interval 4 … 6), …"
std::string quantiles_text(const LimitResult& result) {
  const auto& all = result.realizations;
  const auto found = std::count_if(all.begin(), all.end(), [](const auto& limit) { return limit.found(); });
  std::string text = fmt::format("limits of {} of {} realizations", found, all.size());
  const LimitQuantile median = result.median();
  if (!std::isfinite(median.limit.value)) return text + "\n";
  text += ": median " + result.number_text(median);
  if (std::isfinite(median.limit.low) && std::isfinite(median.limit.high))
    text += fmt::format(" ({:.0f} % interval {} … {})", 100.0 * result.confidence,
                        result.number_text(median.limit.low), result.number_text(median.limit.high));
  text += "\nquantiles:";
  std::string before = " ";
  for (const LimitQuantile& quantile : result.quantiles()) {
    text += fmt::format("{}{:.0f} % {} ({} … {})", before, 100.0 * quantile.p, result.number_text(quantile),
                        result.number_text(quantile.limit.low), result.number_text(quantile.limit.high));
    before = ", ";
  }
  return text + "\n";
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

std::vector<LimitQuantile> LimitResult::quantiles() const {
  std::vector<double> limits;
  for (const RealizationLimit& limit : realizations) {
    if (limit.found()) limits.push_back(limit.limit());
    if (!limit.error.empty()) continue;
    if (limit.state.status == Status::met_at_both) limits.push_back(request.from);
    if (limit.state.status == Status::met_at_none) limits.push_back(request.to);
  }
  std::sort(limits.begin(), limits.end());
  // Limits beyond an end lie anywhere beyond it. A quantile that moves with them is a bound.
  const auto [low, high] = std::minmax(request.from, request.to);
  std::vector<double> lower = limits, higher = limits;
  std::replace(lower.begin(), lower.end(), low, low - (high - low));
  std::replace(higher.begin(), higher.end(), high, high + (high - low));
  std::vector<LimitQuantile> all;
  for (const double p : limit_quantiles) {
    const double value = statistics::quantile(limits, p);
    const statistics::Interval interval = statistics::quantile_interval(limits, p, confidence);
    all.push_back({p,
                   {value, interval.low, interval.high},
                   statistics::quantile(higher, p) > value,
                   statistics::quantile(lower, p) < value});
  }
  return all;
}

LimitQuantile LimitResult::median() const {
  for (const LimitQuantile& quantile : quantiles()) {
    if (quantile.p == 0.5) return quantile;
  }
  return {};
}

std::string LimitResult::number_text(double limit) const {
  if (!std::isfinite(limit)) return "?";
  const char* mark = limit == std::max(request.from, request.to)   ? "≥ "
                     : limit == std::min(request.from, request.to) ? "≤ "
                                                                   : "";
  return fmt::format("{}{:.5g}", mark, limit);
}

std::string LimitResult::number_text(const LimitQuantile& quantile) const {
  if (quantile.at_least == quantile.at_most)
    return quantile.at_least ? "?" : number_text(quantile.limit.value);
  return fmt::format("{}{:.5g}", quantile.at_least ? "≥ " : "≤ ", quantile.limit.value);
}

std::vector<LimitShare> LimitResult::met_shares() const {
  const double sign = request.from < request.to ? 1.0 : -1.0;  // of the way to where it holds
  std::vector<double> places;                                  // times the sign, ascending
  std::size_t n = 0;
  for (const RealizationLimit& limit : realizations) {
    const bool is_beyond = limit.error.empty() && limit.state.status == Status::met_at_none;
    const bool is_before = limit.error.empty() && limit.state.status == Status::met_at_both;
    if (limit.found()) places.push_back(sign * limit.limit());
    if (is_before) places.push_back(sign * request.from);
    if (limit.found() || is_before || is_beyond) ++n;
  }
  if (n == 0) return {};
  std::sort(places.begin(), places.end());
  std::vector<LimitShare> shares;
  const auto add = [&](double place, std::size_t met) {
    shares.push_back({sign * place, statistics::proportion(met, n, confidence)});
  };
  if (places.empty() || places.front() > sign * request.from) add(sign * request.from, 0);
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (k + 1 == places.size() || places[k + 1] > places[k]) add(places[k], k + 1);
  }
  return shares;
}

LimitTrial limit_trial(const LimitCriterion& criterion, const std::string& since, double value,
                       const RunResult& run) {
  const StageMeasures& last = run.stages.at(run.stages.size() - 1);
  const simulation::Damage damage = damage_between(run, since, "").value_or(last.damage);
  LimitTrial trial{value,         run.key, simulation::damage_value(damage, criterion.measure),
                   last.standing, false,   run.state_hash};
  trial.met =
      criterion.collapse ? last.standing != simulation::Standing::stands : trial.measure > criterion.above;
  return trial;
}

std::string limit_text(const LimitResult& result) {
  const LimitRequest& request = result.request;
  const std::string since =
      request.since.empty() ? "" : fmt::format(" since the end of \"{}\"", request.since);
  std::string text = fmt::format("{} until {}{}\n", request.key, request.criterion.text(), since);
  const auto& all = result.realizations;
  for (std::size_t k = 0; k < std::min(all.size(), most_lines); ++k) {
    const std::string which = all.size() == 1 ? "" : fmt::format("realization {}: ", all[k].realization);
    text += which + realization_text(result, all[k]) + "\n";
  }
  if (all.size() > most_lines) text += fmt::format("and {} realizations more\n", all.size() - most_lines);
  if (all.size() < 2 || !result.complete) return text;
  return text + quantiles_text(result);
}

}  // namespace keyblock::study
