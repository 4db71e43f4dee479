#include "study/limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "record/damage_fields.h"
#include "scenario/key_path.h"
#include "statistics/order_statistics.h"
#include "statistics/proportion.h"
#include "statistics/sample.h"
#include "study/measures.h"

namespace keyblock::study {
namespace {

using Status = Bisection::Status;

constexpr double limit_quantiles[] = {0.05, 0.25, 0.5, 0.75, 0.95};

/// Places that a scan of such a key looks at by default.
constexpr int scanned_parts = 8;

}  // namespace

int scan_of(const std::string& key) {
  const auto segments = scenario::parse_key_path(key);
  if (!segments || segments->empty()) return 1;
  const bool is_scale = segments->front().key == "stage" && segments->back().key == "scale";
  return is_scale || segments->front().key == "motion" ? scanned_parts : 1;
}

bool LimitTrial::goes() const {
  return standing != record::Standing::stands && standing != record::Standing::rocks;
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

LimitTrial limit_trial(const LimitRequest& request, double value, const RunResult& run) {
  const LimitCriterion& criterion = request.criterion;
  const StageMeasures& deciding = deciding_stage(run);
  const record::Damage damage =
      damage_between(run, request.since, "").value_or(run.stages.at(run.stages.size() - 1).damage);
  LimitTrial trial;
  trial.value = value;
  trial.run = run.key;
  trial.measure = record::damage_value(damage, criterion.measure);
  trial.standing = deciding.standing;
  trial.moving_area = damage.moving_area;
  trial.met = criterion.is_met(trial.measure, run.block_size, deciding);
  trial.state_hash = run.state_hash;
  trial.movers = deciding.movers;
  trial.heaviest = deciding.heaviest;
  const auto segments = scenario::parse_key_path(request.key);
  if (!segments || segments->size() < 2 || segments->front().key != "stage") return trial;
  const scenario::PathSegment& of = (*segments)[1];
  for (std::size_t k = 0; k < run.stages.size(); ++k)
    if (of.key == run.stages[k].name || of.index == k) trial.pga = run.stages[k].pga;
  return trial;
}

}  // namespace keyblock::study
