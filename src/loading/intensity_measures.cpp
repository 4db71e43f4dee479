#include "loading/intensity_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "loading/motion_series.h"

namespace keyblock::loading {
namespace {

constexpr int angles = 180;
constexpr double right_angle_tolerance = 2.0;  // degrees
constexpr double usual_damping = 0.05;
constexpr double short_period = 0.3, long_period = 1.0;  // s

std::vector<Vec2> velocities(const GroundMotion& motion) {
  std::vector<Vec2> history;
  for (const double t : motion.times()) history.push_back(motion.velocity(t));
  return history;
}

/// ω² x of the oscillators of both directions.
std::vector<Vec2> spectral(const GroundMotion& motion, double period) {
  std::array<std::vector<double>, 2> a, x;
  for (const Vec2 p : motion.accelerations()) {
    a[0].push_back(p.x);
    a[1].push_back(p.y);
  }
  for (std::size_t k = 0; k < 2; ++k) x[k] = oscillator_history(motion.times(), a[k], period, usual_damping);
  const double w2 = std::pow(2.0 * std::numbers::pi / period, 2.0);
  std::vector<Vec2> history;
  for (std::size_t k = 0; k < x[0].size(); ++k) history.push_back(w2 * Vec2{x[0][k], x[1][k]});
  return history;
}

}  // namespace

std::pair<double, double> rotated(const std::vector<Vec2>& history) {
  std::vector<double> largest;
  for (int k = 0; k < angles; ++k) {
    const double angle = std::numbers::pi * k / angles;
    const Vec2 direction{std::cos(angle), std::sin(angle)};
    double most = 0.0;
    for (const Vec2 u : history) most = std::max(most, std::abs(dot(u, direction)));
    largest.push_back(most);
  }
  std::sort(largest.begin(), largest.end());
  return {0.5 * (largest[angles / 2 - 1] + largest[angles / 2]), largest.back()};
}

std::optional<GroundMotion> horizontal_motion(
    const std::vector<std::pair<MotionComponent, ComponentDirection>>& components,
    const ProjectionOptions& options) {
  std::vector<std::pair<MotionComponent, ComponentDirection>> horizontal;
  for (const auto& component : components)
    if (!component.second.vertical) horizontal.push_back(component);
  if (horizontal.size() != 2) return std::nullopt;
  const double apart =
      std::abs(std::remainder(horizontal[1].second.azimuth - horizontal[0].second.azimuth, 180.0));
  if (!(90.0 - apart <= right_angle_tolerance)) return std::nullopt;
  // The window is that of all components.
  ProjectionOptions one = options;
  if (!one.window) {
    double start = HUGE_VAL, end = -HUGE_VAL;
    for (const auto& [component, direction] : components) {
      start = std::min(start, component.time(0));
      end = std::max(end, component.end());
    }
    one.window = std::pair(start, end);
  }
  // The vertical one keeps the times of all three together; along each direction it adds nothing.
  const auto along = [&](double azimuth) {
    one.section_azimuth = azimuth;
    return project_motion("", components, one);
  };
  const GroundMotion north = along(0.0), east = along(90.0);
  std::vector<Vec2> both;
  for (const double t : north.times()) both.push_back({north.at(t).x, east.at(t).x});
  return GroundMotion("", north.times(), std::move(both));
}

std::optional<GroundMotion> horizontal_pair(const std::vector<MotionComponent>& components) {
  std::vector<std::pair<MotionComponent, ComponentDirection>> horizontal;
  for (const MotionComponent& component : components) {
    if (component.vertical || !component.azimuth || component.acceleration.size() < 2) continue;
    horizontal.emplace_back(component, ComponentDirection{false, *component.azimuth});
  }
  return horizontal_motion(horizontal, {});
}

std::vector<RotatedMeasure> rotated_measures(const GroundMotion& horizontal) {
  std::vector<RotatedMeasure> measures;
  const auto add = [&](const char* name, const char* unit, const std::vector<Vec2>& history) {
    const auto [middle, most] = rotated(history);
    measures.push_back({name, unit, middle, most});
  };
  add("PGA", "m/s2", horizontal.accelerations());
  add("PGV", "m/s", velocities(horizontal));
  add("SA(0.3)", "m/s2", spectral(horizontal, short_period));
  add("SA(1.0)", "m/s2", spectral(horizontal, long_period));
  return measures;
}

HorizontalMeasures horizontal_measures(const GroundMotion& horizontal, double factor) {
  const std::vector<RotatedMeasure> all = rotated_measures(horizontal);
  const double f = std::abs(factor);
  return {f * all[0].rotd50, f * all[1].rotd50, f * all[2].rotd50, f * all[3].rotd50};
}

}  // namespace keyblock::loading
