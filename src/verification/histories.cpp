#include "verification/histories.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "scenario/key_path.h"

namespace keyblock::verification {
namespace {

/// A column over time.
struct Series {
  std::vector<double> time, value;
};

Series column(const Outcome& outcome, const std::string& name) {
  const auto found = std::find(outcome.columns.begin(), outcome.columns.end(), name);
  if (found == outcome.columns.end()) {
    const std::string hint = scenario::suggestion(name, outcome.columns);
    throw std::runtime_error(
        fmt::format("there is no column '{}' of histories{}", name, hint.empty() ? "" : "; " + hint));
  }
  if (outcome.rows.empty()) throw std::runtime_error("the histories are empty");
  const auto index = static_cast<std::size_t>(found - outcome.columns.begin());
  Series series;
  for (const auto& row : outcome.rows) {
    series.time.push_back(row[0]);
    series.value.push_back(row[index]);
  }
  return series;
}

double between(double t0, double y0, double t1, double y1, double t) {
  return t1 > t0 ? y0 + (y1 - y0) * (t - t0) / (t1 - t0) : y1;
}

double at(const Series& s, double time) {
  // Times are sums of steps: the last one may miss its round value by rounding.
  const double slack = 1e-9 * std::max(1.0, std::abs(time));
  if (time < s.time.front() - slack || time > s.time.back() + slack) {
    throw std::runtime_error(
        fmt::format("the histories go from {} to {} s, not to {} s", s.time.front(), s.time.back(), time));
  }
  const auto next =
      static_cast<std::size_t>(std::upper_bound(s.time.begin(), s.time.end(), time) - s.time.begin());
  if (next == 0) return s.value.front();
  if (next == s.time.size()) return s.value.back();
  return between(s.time[next - 1], s.value[next - 1], s.time[next], s.value[next], time);
}

double mean(const Series& s) {
  double sum = 0.0;
  for (const double x : s.value) sum += x;
  return sum / static_cast<double>(s.value.size());
}

double crossing_time(double a, double ta, double b, double tb) {
  return ta + (tb - ta) * a / (a - b);
}

double first_crossing(const Series& s, double value) {
  for (std::size_t k = 1; k < s.value.size(); ++k) {
    const double a = s.value[k - 1] - value, b = s.value[k] - value;
    if (a == 0.0) return s.time[k - 1];
    if (a * b <= 0.0) return crossing_time(a, s.time[k - 1], b, s.time[k]);
  }
  throw std::runtime_error(fmt::format("the value {} is never crossed", value));
}

double period(const Series& s) {
  const double middle = mean(s);
  std::vector<double> ups;
  for (std::size_t k = 1; k < s.value.size(); ++k) {
    const double a = s.value[k - 1] - middle, b = s.value[k] - middle;
    if (a < 0.0 && b >= 0.0) ups.push_back(crossing_time(a, s.time[k - 1], b, s.time[k]));
  }
  if (ups.size() < 2) throw std::runtime_error("there is no full period");
  return (ups.back() - ups.front()) / static_cast<double>(ups.size() - 1);
}

double after(const Outcome& outcome, const std::string& stage, const std::string& name) {
  const auto found = outcome.stage_rows.find(stage);
  if (found == outcome.stage_rows.end() || found->second == 0) {
    throw std::runtime_error(fmt::format("there is no stage '{}' with histories", stage));
  }
  return column(outcome, name).value[found->second - 1];
}

}  // namespace

double history_quantity(const Outcome& outcome, std::string_view function,
                        const std::vector<Argument>& arguments) {
  const std::string& name = std::get<std::string>(arguments[0]);
  if (function == "after") return after(outcome, name, std::get<std::string>(arguments[1]));
  const Series s = column(outcome, name);
  const auto [least, most] = std::minmax_element(s.value.begin(), s.value.end());
  if (function == "end") return s.value.back();
  if (function == "first") return s.value.front();
  if (function == "at") return at(s, std::get<double>(arguments[1]));
  if (function == "max") return *most;
  if (function == "min") return *least;
  if (function == "maxabs") return std::max(std::abs(*least), std::abs(*most));
  if (function == "mean") return mean(s);
  if (function == "crossing") return first_crossing(s, std::get<double>(arguments[1]));
  if (function == "period") return period(s);
  throw std::runtime_error(fmt::format("there is no function '{}'", function));
}

}  // namespace keyblock::verification
