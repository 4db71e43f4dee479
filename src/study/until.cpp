#include "study/until.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "simulation/damage_fields.h"

namespace keyblock::study {
namespace {

// Continued fraction of the incomplete beta function (Lentz), as in Numerical Recipes, 6.4.
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300, precision = 1e-15;
  constexpr int most_terms = 500;
  double c = 1.0, d = 1.0 / std::max(tiny, 1.0 - (a + b) * x / (a + 1.0)), h = d;
  for (int m = 1; m < most_terms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    double change = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 + term * d;
      c = 1.0 + term / c;
      if (std::abs(d) < tiny) d = tiny;
      if (std::abs(c) < tiny) c = tiny;
      d = 1.0 / d;
      change = c * d;
      h *= change;
    }
    if (std::abs(change - 1.0) < precision) break;
  }
  return h;
}

double incomplete_beta(double a, double b, double x) {
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  return x < (a + 1.0) / (a + b + 2.0) ? front * beta_fraction(a, b, x) / a
                                       : 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

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
  return (until.half_width && half <= *until.half_width * std::abs(mean)) ||
         (until.width && 2.0 * half <= *until.width);
}

// The measure at the end of the stage at which it is compared; nothing when the run did not come to it.
std::optional<double> measured(const Plan& plan, const RunResult& run) {
  if (!run.error.empty()) return std::nullopt;
  for (const StageMeasures& stage : run.stages) {
    if (stage.name == plan.stage) return simulation::damage_value(stage.damage, plan.until->measure);
  }
  return std::nullopt;
}

}  // namespace

double student_quantile(double p, double freedom) {
  if (p < 0.5) return -student_quantile(1.0 - p, freedom);
  // P(T ≤ x) = 1 − I_y(ν/2, 1/2)/2 with y = ν/(ν + x²), which falls as x grows.
  double low = 0.0, high = 1.0;
  const double tail = 2.0 * (1.0 - p);
  for (int k = 0; k < 200; ++k) {
    const double y = 0.5 * (low + high);
    (incomplete_beta(0.5 * freedom, 0.5, y) < tail ? low : high) = y;
  }
  return low > 0.0 ? std::sqrt(freedom * (1.0 - low) / low) : std::numeric_limits<double>::infinity();
}

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
    if (added && count > 1) place->second = student_quantile(0.5 + 0.5 * plan.confidence, count - 1.0);
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
