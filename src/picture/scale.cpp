#include "picture/scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace keyblock::picture {
namespace {

constexpr double rounding = 1e-9;

struct Unit {
  double factor;
  const char* name;
};

std::span<const Unit> units_of(Quantity quantity) {
  static constexpr Unit length[] = {{1.0, "m"}, {1e-3, "mm"}, {1e-6, "µm"}};
  static constexpr Unit stress[] = {{1e6, "MPa"}, {1e3, "kPa"}, {1.0, "Pa"}};
  static constexpr Unit velocity[] = {{1.0, "m/s"}, {1e-3, "mm/s"}};
  static constexpr Unit density[] = {{1.0, "kg/m³"}};
  static constexpr Unit force[] = {{1e6, "MN/m"}, {1e3, "kN/m"}, {1.0, "N/m"}};
  static constexpr Unit share[] = {{0.01, "%"}};
  static constexpr Unit none[] = {{1.0, ""}};
  switch (quantity) {
    case Quantity::length:
      return length;
    case Quantity::stress:
      return stress;
    case Quantity::velocity:
      return velocity;
    case Quantity::density:
      return density;
    case Quantity::force:
      return force;
    case Quantity::share:
      return share;
    case Quantity::none:
      break;
  }
  return none;
}

double power_of_ten(double x) {
  return std::pow(10.0, std::floor(std::log10(x) + rounding));
}

}  // namespace

std::string with_unit(double value, Quantity quantity, int digits) {
  const auto units = units_of(quantity);
  Unit unit = units.back();
  for (const Unit& u : units) {
    if (std::abs(value) < u.factor * (1.0 - rounding)) continue;
    unit = u;
    break;
  }
  if (value == 0.0) unit = units.front();
  const std::string number = fmt::format("{:.{}g}", value / unit.factor, digits);
  return *unit.name == '\0' ? number : number + "\u00a0" + unit.name;
}

double nice_above(double x) {
  const double power = power_of_ten(x);
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= x * (1.0 - rounding)) return m * power;
  return 10.0 * power;
}

double nice_below(double x) {
  const double power = power_of_ten(x);
  for (const double m : {5.0, 2.0})
    if (m * power <= x * (1.0 + rounding)) return m * power;
  return power;
}

double Scale::place(double value) const {
  const double t = logarithmic ? std::log(std::max(value, low) / low) / std::log(high / low)
                               : (value - low) / (high - low);
  return t > 0.0 ? std::min(t, 1.0) : 0.0;
}

std::vector<double> Scale::ticks() const {
  constexpr double room = 0.09;  // of the bar, between labels
  std::vector<double> values{low, high};
  const auto add = [&](double value) {
    for (const double other : values)
      if (std::abs(place(value) - place(other)) < room) return;
    values.push_back(value);
  };
  if (logarithmic) {
    for (double decade = power_of_ten(low) * 10.0; decade < high; decade *= 10.0) add(decade);
    return values;
  }
  const double step = nice_above((high - low) / 5.0);
  if (low < 0.0 && high > 0.0) add(0.0);
  for (double k = std::ceil(low / step); k * step < high; ++k) add(k * step);
  return values;
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto k = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

Scale scale_of_sizes(std::vector<double> values) {
  constexpr double usual = 1e-3, far_above = 30.0;
  std::erase_if(values, [](double v) { return !(v > 0.0) || !std::isfinite(v); });
  const double largest = quantile(values, 1.0);
  if (!(largest > 0.0)) return {0.0, usual, false};
  const double high = nice_above(largest);
  // A few fallen blocks move metres, the rest millimetres: then only a logarithmic scale shows both.
  if (largest < far_above * quantile(values, 0.5)) return {0.0, high, false};
  const double decades = std::clamp(std::ceil(std::log10(high / quantile(values, 0.1))), 2.0, 5.0);
  return {high / std::pow(10.0, decades), high, true};
}

Scale scale_of_stresses(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  const double least = quantile(values, 0.02), most = quantile(values, 0.98);
  const double low = least < 0.0 ? -nice_above(-least) : 0.0;
  const double high = most > 0.0 && most > -0.02 * low ? nice_above(most) : 0.0;
  return low < high ? Scale{low, high, false} : Scale{-1.0, 0.0, false};
}

Scale scale_between(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  const double low = quantile(values, 0.0), high = quantile(values, 1.0);
  return low < high ? Scale{low, high, false} : Scale{low - 0.5, low + 0.5, false};
}

Scale scale_of_joints(double largest) {
  constexpr double least = 1e-5;  // m
  const double high = nice_above(std::max(largest, least));
  return {high / 1e3, high, true};
}

}  // namespace keyblock::picture
