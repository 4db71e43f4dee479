#include "study/until.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "record/damage_fields.h"
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

// The confidence interval of a mean; without two values there is none.
struct MeanInterval {
  double mean = 0.0, half_width = 0.0;
  bool varies = false;
};

std::optional<MeanInterval> interval_of(const Sums& s, double quantile) {
  if (s.count < 2) return std::nullopt;
  const double n = s.count, mean = s.first + s.sum / n;
  const double variance = std::max(0.0, (s.squares - s.sum * s.sum / n) / (n - 1.0));
  return MeanInterval{mean, quantile * std::sqrt(variance / n), variance > 0.0};
}

bool narrow(const std::optional<MeanInterval>& interval, const scenario::UntilSpec& until) {
  if (!interval) return false;
  return (until.half_width && interval->varies &&
          interval->half_width <= *until.half_width * std::abs(interval->mean)) ||
         (until.width && 2.0 * interval->half_width <= *until.width);
}

// How many times wider an interval is than asked for; endless where nothing varies or the mean is zero.
double excess(const std::optional<MeanInterval>& interval, const scenario::UntilSpec& until) {
  double least = HUGE_VAL;
  if (!interval) return least;
  const double half = interval->half_width;
  if (until.half_width && interval->varies && interval->mean != 0.0)
    least = half / (*until.half_width * std::abs(interval->mean));
  if (until.width) least = std::min(least, 2.0 * half / *until.width);
  return least;
}

// The measure as it is compared; nothing when the run did not come to it or does not have it.
std::optional<double> measured(const Plan& plan, const RunResult& run, const RunResult* control) {
  const auto damage = control == nullptr ? damage_between(run, plan.since, plan.stage)
                                         : damage_beyond(run, *control, plan.since, plan.stage);
  if (!damage) return std::nullopt;
  const double value = record::damage_value(*damage, plan.until->measure);
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

using AxisValues = std::vector<std::vector<std::string>>;

std::string combination_text(const Plan& plan, const AxisValues& values) {
  std::string text;
  for (std::size_t a = 0; a < std::min(values.size(), plan.axes.size()); ++a) {
    for (std::size_t j = 0; j < values[a].size(); ++j)
      text += (text.empty() ? " at " : ", ") + plan.axes[a].keys.at(j) + " = " + values[a][j];
  }
  return text;
}

std::string interval_text(const std::optional<MeanInterval>& interval, const scenario::UntilSpec& until) {
  if (!interval) return "fewer than two values";
  if (!interval->varies) return fmt::format("all values are {:.4g}", interval->mean);
  std::string text = fmt::format("{:.4g} ± {:.4g}", interval->mean, interval->half_width);
  if (until.half_width && interval->mean != 0.0)
    text +=
        fmt::format(", a half width of {:.3g} of the mean", interval->half_width / std::abs(interval->mean));
  return text;
}

std::string asked_text(const scenario::UntilSpec& until) {
  std::string text;
  if (until.half_width) text = fmt::format("half_width = {}", *until.half_width);
  if (until.width) text += (text.empty() ? "" : " or ") + fmt::format("width = {}", *until.width);
  return text;
}

/// The control runs of a plan, as far as they are there.
class Controls {
 public:
  Controls(const Plan& plan, const std::vector<const RunResult*>& results)
      : places_(control_places(plan)), results_(results) {}
  [[nodiscard]] bool is_missing(std::size_t run) const { return places_[run] >= 0 && of(run) == nullptr; }
  [[nodiscard]] const RunResult* of(std::size_t run) const {
    return places_[run] < 0 ? nullptr : results_[static_cast<std::size_t>(places_[run])];
  }

 private:
  std::vector<std::ptrdiff_t> places_;
  const std::vector<const RunResult*>& results_;
};

/// Places in the plan of the runs that count, of each realization.
std::map<int, std::vector<std::size_t>> runs_by_realization(const Plan& plan) {
  std::map<int, std::vector<std::size_t>> runs;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    if (plan.runs[k].wanted && plan.runs[k].variant.empty()) runs[plan.runs[k].realization].push_back(k);
  }
  return runs;
}

}  // namespace

std::optional<int> enough_realizations(const Plan& plan, const std::vector<const RunResult*>& results) {
  if (!plan.until) return std::nullopt;
  const Controls controls(plan, results);
  std::map<AxisValues, Sums> sums;
  std::map<int, double> quantiles;  // that were needed before
  const auto quantile = [&](int count) {
    const auto [place, added] = quantiles.try_emplace(count, 0.0);
    if (added && count > 1) place->second = statistics::student_t(plan.confidence, count - 1);
    return place->second;
  };
  for (const auto& [realization, runs] : runs_by_realization(plan)) {
    for (const std::size_t k : runs) {
      if (results[k] == nullptr || controls.is_missing(k)) return std::nullopt;
      Sums& sum = sums[plan.runs[k].values];
      if (const auto value = measured(plan, *results[k], controls.of(k))) sum.add(*value);
    }
    if (realization + 1 < plan.until->minimum) continue;
    const bool enough = std::all_of(sums.begin(), sums.end(), [&](const auto& entry) {
      return narrow(interval_of(entry.second, quantile(entry.second.count)), *plan.until);
    });
    if (enough) return realization + 1;
  }
  return std::nullopt;
}

std::string lacking_precision(const Plan& plan, const std::vector<const RunResult*>& results) {
  if (!plan.until || enough_realizations(plan, results)) return {};
  const Controls controls(plan, results);
  std::map<AxisValues, Sums> sums;
  for (std::size_t k = 0; k < plan.runs.size(); ++k) {
    const PlannedRun& run = plan.runs[k];
    if (!run.wanted || !run.variant.empty()) continue;
    if (results[k] == nullptr || controls.is_missing(k)) return {};
    Sums& sum = sums[run.values];
    if (const auto value = measured(plan, *results[k], controls.of(k))) sum.add(*value);
  }
  std::size_t wide = 0;
  double largest = -1.0;
  std::string text;
  for (const auto& [values, sum] : sums) {
    const double quantile = sum.count < 2 ? 0.0 : statistics::student_t(plan.confidence, sum.count - 1);
    const auto interval = interval_of(sum, quantile);
    if (narrow(interval, *plan.until)) continue;
    ++wide;
    const double now = excess(interval, *plan.until);
    if (now <= largest) continue;
    largest = now;
    text = fmt::format("{}{}: {}", plan.until->measure, combination_text(plan, values),
                       interval_text(interval, *plan.until));
  }
  const std::string of_all =
      sums.size() == 1 ? "" : fmt::format("{} of {} combinations; ", wide, sums.size());
  return fmt::format("{}{} (asked for: {})", of_all, text, asked_text(*plan.until));
}

}  // namespace keyblock::study
