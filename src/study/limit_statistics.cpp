#include "study/limit_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "results/csv.h"
#include "statistics/distributions.h"
#include "statistics/proportion.h"
#include "statistics/sample.h"

namespace keyblock::study {
namespace {

using Status = Bisection::Status;

/// Of realizations whose search has ended: the limit, or the end beyond which it lies.
std::vector<std::pair<const RealizationLimit*, double>> ended(const LimitResult& result) {
  std::vector<std::pair<const RealizationLimit*, double>> all;
  for (const RealizationLimit& limit : result.realizations) {
    if (!limit.error.empty()) continue;
    if (limit.state.status == Status::met_at_both) all.emplace_back(&limit, result.request.from);
    if (limit.state.status == Status::met_at_none) all.emplace_back(&limit, result.request.to);
    if (limit.found()) all.emplace_back(&limit, limit.limit());
  }
  return all;
}

std::vector<double> limits_of(const LimitResult& result) {
  std::vector<double> limits;
  for (const auto& [realization, limit] : ended(result)) limits.push_back(limit);
  return limits;
}

}  // namespace

LimitMean mean_limit(const LimitResult& result) {
  const std::vector<double> limits = limits_of(result);
  LimitMean found;
  found.n = limits.size();
  found.mean.value = statistics::mean(limits);
  found.standard_deviation = statistics::standard_deviation(limits);
  const auto [low, high] = std::minmax(result.request.from, result.request.to);
  for (const auto& [realization, limit] : ended(result)) {
    if (realization->found()) continue;
    (limit == high ? found.at_least : found.at_most) = true;
  }
  if (found.at_least || found.at_most || found.n < 2) return found;
  const double reach = statistics::student_t(result.confidence, static_cast<int>(found.n) - 1) *
                       found.standard_deviation / std::sqrt(static_cast<double>(found.n));
  found.mean.low = found.mean.value - reach;
  found.mean.high = found.mean.value + reach;
  return found;
}

std::optional<FailureShare> failure_share(const LimitResult& result) {
  if (!result.request.decided_value()) return std::nullopt;
  const std::vector<double> limits = limits_of(result);
  FailureShare found;
  found.n = limits.size();
  found.below =
      static_cast<std::size_t>(std::ranges::count_if(limits, [](double limit) { return limit < 1.0; }));
  found.share = statistics::proportion(found.below, found.n, result.confidence);
  return found;
}

std::vector<Dependence> dependences(const LimitResult& result) {
  std::vector<const Strengths*> strengths;
  for (const auto& [realization, limit] : ended(result)) strengths.push_back(&realization->strengths);
  return dependences(strengths, limits_of(result), result.confidence);
}

std::string statistics_csv(const LimitResult& result) {
  std::string text = "quantity,value,low,high\n";
  const auto add = [&](const std::string& quantity, const statistics::Estimate& estimate) {
    text += results::csv_field(quantity);
    for (const double number : {estimate.value, estimate.low, estimate.high})
      text += std::isfinite(number) ? fmt::format(",{}", number) : ",";
    text += "\n";
  };
  const LimitMean mean = mean_limit(result);
  add("mean", mean.mean);
  add("standard_deviation", {mean.standard_deviation, statistics::not_a_number, statistics::not_a_number});
  for (const LimitQuantile& quantile : result.quantiles())
    add(fmt::format("quantile {}", quantile.p), quantile.limit);
  if (const auto failure = failure_share(result)) add("probability below 1", failure->share);
  for (const Dependence& one : dependences(result)) {
    add("rank correlation with " + one.strength, one.rank_correlation);
    add("first-order index of " + one.strength, one.first_order);
  }
  return text;
}

}  // namespace keyblock::study
