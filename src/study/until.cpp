#include "study/until.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "simulation/damage_fields.h"
#include "statistics/distributions.h"
#include "study/measures.h"

namespace keyblock::study {
namespace {

struct Sums {
  int count = 0;
  double sum = 0.0, squares = 0.0;  // of the differences to the first value, for accuracy
  double first = 0.0;
  void add(double x) {
    if (count++ == 0) first = x;
    sum += x - first;
    squares += (x - first) * (x - first);
  }
};

bool narrow(const Sums& s, const scenario::UntilSpec& until, double quantile) {
  if (s.count < 2) return false;
  const double n = s.count, mean = s.first + s.sum / n;
  const double variance = std::max(0.0, (s.squares - s.sum * s.sum / n) / (n - 1.0));
  const double half = quantile * std::sqrt(variance / n);
  return (until.half_width && variance > 0.0 && half <= *until.half_width * std::abs(mean)) ||
         (until.width && 2.0 * half <= *until.width);
}

// The measure as it is compared; nothing when the run did not come to it.
std::optional<double> measured(const Plan& plan, const RunResult& run) {
  const auto damage = damage_between(run, plan.since, plan.stage);
  if (!damage) return std::nullopt;
  return simulation::damage_value(*damage, plan.until->measure);
}

}  // namespace

std::optional<int> enough_realizations(const Plan& plan, const std::vector<const RunResult*>& results) {
  if (!plan.until) return std::nullopt;
  std::map<int, std::vector<std::size_t>> by_realization;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (plan.runs[k].wanted && plan.runs[k].variant.empty())
      by_realization[plan.runs[k].realization].push_back(k);
  }
  std::map<std::vector<std::vector<std::string>>, Sums> sums;
  std::map<int, double> quantiles;  // that were needed before
  const auto quantile = [&](int count) {
    const auto [place, added] = quantiles.try_emplace(count, 0.0);
    if (added && count > 1) place->second = statistics::student_t(plan.confidence, count - 1);
    return place->second;
  };
  for (const auto& [realization, runs] : by_realization) {
    for (const std::size_t k : runs) {
      if (results[k] == nullptr) return std::nullopt;
      Sums& sum = sums[plan.runs[k].values];
      if (const auto value = measured(plan, *results[k])) sum.add(*value);
    }
    if (realization + 1 < plan.until->minimum) continue;
    const bool enough = std::all_of(sums.begin(), sums.end(), [&](const auto& entry) {
      return narrow(entry.second, *plan.until, quantile(entry.second.count));
    });
    if (enough) return realization + 1;
  }
  return std::nullopt;
}

}  // namespace keyblock::study
