#include "loading/intensity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "loading/intensity_measures.h"
#include "loading/motion_file.h"
#include "loading/motion_series.h"

namespace keyblock::loading {
namespace {

constexpr double damping_of_spectra = 0.05;
constexpr int periods_of_average = 10, directions = 180;
constexpr double shortest_of_spectra = 0.005, longest_of_spectra = 20.0;  // s

using Samples = std::vector<double>;

/// The numbers between the brackets of "NAME(1,2)"; none where it is not of this form.
std::optional<std::vector<double>> bracketed(std::string_view text, std::string_view name) {
  if (!text.starts_with(name) || text.size() < name.size() + 3 || text[name.size()] != '(' ||
      text.back() != ')')
    return std::nullopt;
  std::string_view inner = text.substr(name.size() + 1, text.size() - name.size() - 2);
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = inner.find(',');
    std::string_view field = inner.substr(0, comma);
    while (field.starts_with(' ')) field.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), number);
    if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
    if (!(number >= shortest_of_spectra && number <= longest_of_spectra)) return std::nullopt;
    numbers.push_back(number);
    if (comma == std::string_view::npos) return numbers;
    inner.remove_prefix(comma + 1);
  }
}

std::optional<IntensityName> spectral_name(std::string_view text) {
  if (const auto one = bracketed(text, "SA"); one && one->size() == 1)
    return IntensityName{IntensityKind::sa, std::string(text), *one, 0.0, "m/s2", 1};
  const auto two = bracketed(text, "AvgSA");
  if (!two || two->size() != 2 || !((*two)[0] < (*two)[1])) return std::nullopt;
  IntensityName name{IntensityKind::average_sa, std::string(text), {}, 0.0, "m/s2", 1};
  for (int k = 0; k < periods_of_average; ++k)
    name.periods.push_back((*two)[0] *
                           std::pow((*two)[1] / (*two)[0], k / static_cast<double>(periods_of_average - 1)));
  return name;
}

double peak_of(const Samples& u) {
  double most = 0.0;
  for (const double x : u) most = std::max(most, std::abs(x));
  return most;
}

Samples integral_of(const Samples& time, const Samples& u) {
  Samples sum(u.size(), 0.0);
  for (std::size_t k = 1; k < u.size(); ++k)
    sum[k] = sum[k - 1] + 0.5 * (time[k] - time[k - 1]) * (u[k - 1] + u[k]);
  return sum;
}

/// The second integral of u, which is linear between samples, from the first.
Samples displacement_of(const Samples& time, const Samples& u, const Samples& v) {
  Samples sum(u.size(), 0.0);
  for (std::size_t k = 1; k < u.size(); ++k) {
    const double h = time[k] - time[k - 1];
    sum[k] = sum[k - 1] + h * (v[k - 1] + h / 6.0 * (2.0 * u[k - 1] + u[k]));
  }
  return sum;
}

Samples squares_of(const Samples& time, const Samples& u) {
  Samples sum(u.size(), 0.0);
  for (std::size_t k = 1; k < u.size(); ++k)
    sum[k] =
        sum[k - 1] + (time[k] - time[k - 1]) / 3.0 * (u[k - 1] * u[k - 1] + u[k - 1] * u[k] + u[k] * u[k]);
  return sum;
}

double absolute_of(const Samples& time, const Samples& u) {
  double sum = 0.0;
  for (std::size_t k = 1; k < u.size(); ++k) {
    const double p = u[k - 1], q = u[k], h = time[k] - time[k - 1];
    sum += p * q < 0.0 ? h * (p * p + q * q) / (2.0 * std::abs(p - q)) : h * 0.5 * std::abs(p + q);
  }
  return sum;
}

double time_where(const Samples& time, const Samples& sum, double share) {
  const double wanted = share * sum.back();
  const auto k = static_cast<std::size_t>(std::lower_bound(sum.begin(), sum.end(), wanted) - sum.begin());
  if (k == 0) return time.front();
  return time[k - 1] + (time[k] - time[k - 1]) * (wanted - sum[k - 1]) / (sum[k] - sum[k - 1]);
}

double duration_of(const Samples& time, const Samples& u, double share) {
  constexpr double begin = 0.05;
  const Samples sum = squares_of(time, u);
  return sum.back() > 0.0 ? time_where(time, sum, share) - time_where(time, sum, begin) : 0.0;
}

double angular(double period) {
  return 2.0 * std::numbers::pi / period;
}

/// ω² x.
Samples pseudo_acceleration(const Samples& time, const Samples& u, double period) {
  Samples x = oscillator_history(time, u, period, damping_of_spectra);
  for (double& value : x) value *= angular(period) * angular(period);
  return x;
}

double logarithmic_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

/// The values of both directions as one, by a rule that takes no turning.
double combined(double a, double b, DirectionRule rule) {
  if (rule == DirectionRule::larger) return std::max(a, b);
  return rule == DirectionRule::geometric_mean ? std::sqrt(a * b) : 0.5 * (a + b);
}

/// Of a value for each direction: the median, or the largest.
double of_directions(std::vector<double> values, DirectionRule rule) {
  std::sort(values.begin(), values.end());
  if (rule == DirectionRule::rotd100) return values.back();
  return 0.5 * (values[directions / 2 - 1] + values[directions / 2]);
}

std::array<Samples, 2> components_of(const GroundMotion& horizontal, double azimuth) {
  const double turn = azimuth * std::numbers::pi / 180.0;
  const Vec2 along{std::cos(turn), std::sin(turn)}, across{-std::sin(turn), std::cos(turn)};
  std::array<Samples, 2> u;
  for (const Vec2 a : horizontal.accelerations()) {
    u[0].push_back(dot(a, along));
    u[1].push_back(dot(a, across));
  }
  return u;
}

/// What is linear in the acceleration, over time, whose peak is the intensity.
Samples response(const Samples& time, const Samples& u, IntensityKind kind, double period) {
  switch (kind) {
    case IntensityKind::pgv:
      return integral_of(time, u);
    case IntensityKind::pgd:
      return displacement_of(time, u, integral_of(time, u));
    case IntensityKind::sa:
    case IntensityKind::average_sa:
      return pseudo_acceleration(time, u, period);
    default:
      return u;
  }
}

bool is_peak(IntensityKind kind) {
  return kind != IntensityKind::arias && kind != IntensityKind::cav && kind != IntensityKind::duration;
}

double rotated_peak(const Samples& time, const std::array<Samples, 2>& u, IntensityKind kind, double period,
                    DirectionRule rule) {
  const Samples x = response(time, u[0], kind, period), y = response(time, u[1], kind, period);
  std::vector<Vec2> history(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) history[k] = {x[k], y[k]};
  const auto [middle, most] = rotated(history);
  return rule == DirectionRule::rotd50 ? middle : most;
}

double turned(const Samples& time, const std::array<Samples, 2>& u, const IntensityName& name,
              DirectionRule rule) {
  if (is_peak(name.kind)) {
    std::vector<double> values;
    for (const double period : name.periods.empty() ? std::vector{0.0} : name.periods)
      values.push_back(rotated_peak(time, u, name.kind, period, rule));
    return values.size() == 1 ? values.front() : logarithmic_mean(values);
  }
  std::vector<double> values;
  Samples along(u[0].size());
  for (int k = 0; k < directions; ++k) {
    const double angle = std::numbers::pi * k / directions;
    for (std::size_t i = 0; i < along.size(); ++i)
      along[i] = std::cos(angle) * u[0][i] + std::sin(angle) * u[1][i];
    values.push_back(intensity_along(time, along, name));
  }
  return of_directions(std::move(values), rule);
}

}  // namespace

std::optional<IntensityName> intensity_named(std::string_view text) {
  using enum IntensityKind;
  const IntensityName plain[] = {
      {pga, "PGA", {}, 0.0, "m/s2", 1},      {pgv, "PGV", {}, 0.0, "m/s", 1},
      {pgd, "PGD", {}, 0.0, "m", 1},         {arias, "IA", {}, 0.0, "m/s", 2},
      {cav, "CAV", {}, 0.0, "m/s", 1},       {duration, "RSD575", {}, 0.75, "s", 0},
      {duration, "RSD595", {}, 0.95, "s", 0}};
  for (const IntensityName& name : plain)
    if (name.text == text) return name;
  return spectral_name(text);
}

double intensity_along(const Samples& time, const Samples& acceleration, const IntensityName& name) {
  if (acceleration.empty()) return 0.0;
  switch (name.kind) {
    case IntensityKind::arias:
      return std::numbers::pi / (2.0 * standard_gravity) * squares_of(time, acceleration).back();
    case IntensityKind::cav:
      return absolute_of(time, acceleration);
    case IntensityKind::duration:
      return duration_of(time, acceleration, name.share);
    default:
      break;
  }
  std::vector<double> values;
  for (const double period : name.periods.empty() ? std::vector{0.0} : name.periods)
    values.push_back(peak_of(response(time, acceleration, name.kind, period)));
  return values.size() == 1 ? values.front() : logarithmic_mean(values);
}

double intensity_of(const GroundMotion& horizontal, const IntensityName& name, DirectionRule rule,
                    double azimuth) {
  const auto u = components_of(horizontal, azimuth);
  if (rule == DirectionRule::rotd50 || rule == DirectionRule::rotd100)
    return turned(horizontal.times(), u, name, rule);
  return combined(intensity_along(horizontal.times(), u[0], name),
                  intensity_along(horizontal.times(), u[1], name), rule);
}

}  // namespace keyblock::loading
