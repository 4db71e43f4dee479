#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/checked_json.h"
#include "record/standing.h"
#include "results/csv.h"
#include "results/json_parts.h"
#include "study/estimate_json.h"
#include "study/limit_statistics.h"
#include "study/limit_words.h"

namespace keyblock::study {
namespace {

using nlohmann::ordered_json;

const char* status_word(const RealizationLimit& limit) {
  if (!limit.error.empty()) return "failed";
  switch (limit.state.status) {
    case Bisection::Status::found:
      return "found";
    case Bisection::Status::met_at_both:
      return "met at both ends";
    case Bisection::Status::met_at_none:
      return "met at no end";
    case Bisection::Status::ends_swapped:
      return "ends swapped";
    case Bisection::Status::open:
      break;
  }
  return "open";
}

ordered_json bound_json(const LimitQuantile& quantile) {
  if (quantile.at_least && quantile.at_most) return "not known";
  if (quantile.at_least) return "at least";
  return quantile.at_most ? ordered_json("at most") : ordered_json();
}

ordered_json trial_json(const LimitTrial& trial) {
  return {{"value", trial.value},
          {"met", trial.met},
          {"measure", results::number_or_null(trial.measure)},
          {"moving_area_m2", results::number_or_null(trial.moving_area)},
          {"standing", record::standing_name(trial.standing)},
          {"movers", results::movers_json(trial.movers)},
          {"run", "runs/" + trial.run},
          {"state_hash", trial.state_hash}};
}

/// Where the criterion begins to hold, and where it ends to.
ordered_json limits_json(const RealizationLimit& limit) {
  ordered_json all = ordered_json::array();
  for (const Bisection::Bracket& bracket : limit.state.limits) {
    const LimitTrial* beyond = limit.trial_at(bracket.met);
    all.push_back(
        {{"limit", bracket.middle()},
         {"not_met", bracket.not_met},
         {"met", bracket.met},
         {"just_beyond", beyond == nullptr ? ordered_json() : ordered_json("runs/" + beyond->run)}});
  }
  return all;
}

/// From where on blocks do not stand, and up to where they do.
ordered_json falls_json(const RealizationLimit& limit) {
  if (!limit.falls) return {};
  return {{"stands_to", limit.stands_to}, {"trial", trial_json(*limit.falls)}};
}

ordered_json realization_json(const RealizationLimit& limit) {
  ordered_json trials = ordered_json::array(), strengths = ordered_json::object(), bracket, beyond, error;
  for (const auto& [name, value] : limit.strengths) strengths[name] = results::number_or_null(value);
  for (const LimitTrial& trial : limit.trials) trials.push_back(trial_json(trial));
  if (limit.is_bracketed()) bracket = {{"not_met", limit.state.not_met}, {"met", limit.state.met}};
  if (const LimitTrial* trial = limit.just_beyond()) beyond = "runs/" + trial->run;
  if (!limit.error.empty()) error = limit.error;
  return {{"realization", limit.realization},
          {"status", status_word(limit)},
          {"bracket", bracket},
          {"limit", limit.found() ? results::number_or_null(limit.limit()) : ordered_json()},
          {"just_beyond", beyond},
          {"falls", falls_json(limit)},
          {"limits", limits_json(limit)},
          {"moves_already", limit.moves ? trial_json(*limit.moves) : ordered_json()},
          {"error", error},
          {"strengths", strengths},
          {"trials", trials}};
}

ordered_json mean_json(const LimitResult& result) {
  const LimitMean mean = mean_limit(result);
  LimitQuantile bound;
  bound.at_least = mean.at_least;
  bound.at_most = mean.at_most;
  ordered_json json{{"n", mean.n}};
  json.update(estimate_json(mean.mean));
  json["bound"] = bound_json(bound);
  json["standard_deviation"] = results::number_or_null(mean.standard_deviation);
  return json;
}

/// null where it is not asked for.
ordered_json failure_json(const LimitResult& result) {
  const std::optional<FailureShare> failure = failure_share(result);
  if (!failure) return {};
  ordered_json json{{"n", failure->n}, {"below", failure->below}};
  json.update(estimate_json(failure->share));
  return json;
}

ordered_json dependences_json(const LimitResult& result) {
  ordered_json rows = ordered_json::array();
  for (const Dependence& one : dependences(result))
    rows.push_back({{"strength", one.strength},
                    {"rank_correlation", estimate_json(one.rank_correlation)},
                    {"first_order_index", estimate_json(one.first_order)}});
  return rows;
}

/// Columns.
ordered_json shares_json(const LimitResult& result) {
  ordered_json value = ordered_json::array(), share = value, low = value, high = value;
  for (const LimitShare& step : result.met_shares()) {
    value.push_back(step.value);
    share.push_back(step.share.value);
    low.push_back(step.share.low);
    high.push_back(step.share.high);
  }
  return {{"value", value}, {"share", share}, {"low", low}, {"high", high}};
}

}  // namespace

std::string limit_csv(const LimitResult& result) {
  std::string text = "realization,status,not_met,met,limit,runs,just_beyond";
  const auto first = std::ranges::find_if(
      result.realizations, [](const RealizationLimit& limit) { return !limit.strengths.empty(); });
  const auto known = first == result.realizations.end() ? RealizationLimit{}.strengths : first->strengths;
  for (const auto& [name, value] : known) text += "," + results::csv_field(name);
  text += "\n";
  for (const RealizationLimit& limit : result.realizations) {
    text += fmt::format("{},{},", limit.realization, status_word(limit));
    const LimitTrial* beyond = limit.just_beyond();
    if (beyond != nullptr) {
      text += fmt::format("{},{},{},{},runs/{}", limit.state.not_met, limit.state.met, limit.limit(),
                          limit.trials.size(), beyond->run);
    } else {
      text += fmt::format(",,,{},", limit.trials.size());
    }
    for (std::size_t k = 0; k < known.size(); ++k)
      text += k < limit.strengths.size() ? fmt::format(",{}", limit.strengths[k].second) : ",";
    text += "\n";
  }
  return text;
}

std::string limit_json(const LimitResult& result) {
  const LimitRequest& request = result.request;
  const bool has_threshold = request.criterion.by_measure && !request.criterion.above_share;
  ordered_json above = has_threshold ? ordered_json(request.criterion.above) : ordered_json();
  ordered_json realizations = ordered_json::array();
  for (const RealizationLimit& limit : result.realizations) realizations.push_back(realization_json(limit));
  const LimitQuantile median = result.median();
  ordered_json interval, quantiles = ordered_json::array(), since;
  if (std::isfinite(median.limit.low) && std::isfinite(median.limit.high))
    interval = {median.limit.low, median.limit.high};
  for (const LimitQuantile& quantile : result.quantiles())
    quantiles.push_back({{"p", quantile.p},
                         {"value", results::number_or_null(quantile.limit.value)},
                         {"bound", bound_json(quantile)},
                         {"low", results::number_or_null(quantile.limit.low)},
                         {"high", results::number_or_null(quantile.limit.high)}});
  if (!request.since.empty()) since = request.since;
  const ordered_json why =
      request.criterion.why.empty() ? ordered_json() : ordered_json(request.criterion.why);
  const ordered_json json{{"title", result.title},
                          {"scenario", result.scenario},
                          {"version", result.version},
                          {"seed", result.seed},
                          {"overrides", result.overrides},
                          {"answer", answer_text(result)},
                          {"key", request.key},
                          {"unit", result.unit},
                          {"from", request.from},
                          {"to", request.to},
                          {"until", request.criterion.name},
                          {"why", why},
                          {"measure", request.criterion.measure},
                          {"above", above},
                          {"above_share", results::or_null(request.criterion.above_share)},
                          {"since", since},
                          {"tolerance", request.tolerance},
                          {"scan", request.scan},
                          {"rest_until_still", request.has_rest},
                          {"complete", result.complete},
                          {"median",
                           {{"value", results::number_or_null(median.limit.value)},
                            {"bound", bound_json(median)},
                            {"confidence", result.confidence},
                            {"interval", interval}}},
                          {"mean", mean_json(result)},
                          {"quantiles", quantiles},
                          {"probability_below_1", failure_json(result)},
                          {"hangs_on", dependences_json(result)},
                          {"ground", results::ground_json(result.ground)},
                          {"warnings", result.warnings},
                          {"met_share", shares_json(result)},
                          {"realizations", realizations}};
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace keyblock::study
