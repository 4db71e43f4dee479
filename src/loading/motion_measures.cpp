#include "loading/motion_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "loading/intensity_measures.h"

namespace keyblock::loading {
namespace {

constexpr std::size_t longest_text = 200;  // characters of an event, a station, a label

// Time at which the ascending cumulative sum reaches `level`, linear between samples.
double time_of(const MotionComponent& component, const std::vector<double>& cumulative, double level) {
  const auto next = static_cast<std::size_t>(std::lower_bound(cumulative.begin(), cumulative.end(), level) -
                                             cumulative.begin());
  if (next == 0) return component.time(0);
  if (next == cumulative.size()) return component.end();
  const double s = (level - cumulative[next - 1]) / (cumulative[next] - cumulative[next - 1]);
  return (1.0 - s) * component.time(next - 1) + s * component.time(next);
}

std::string direction(const MotionComponent& component) {
  if (component.vertical) return "up";
  return component.azimuth ? fmt::format("azimuth {}°", *component.azimuth) : "direction not stated";
}

// Largest |v| of a stretch of h seconds on which acceleration goes straight from a to b, v at its start. Within it |v| is largest where
// v·a, a cubic in time, goes through zero: between the places where that turns round.
double peak_velocity(Vec2 v, Vec2 a, Vec2 b, double h) {
  const Vec2 d = b - a;
  const auto velocity = [&](double s) { return v + h * s * (a + 0.5 * s * d); };
  const auto growth = [&](double s) { return dot(velocity(s), a + s * d); };
  // Its slope over s: p s² + q s + r.
  const double p = 1.5 * h * dot(d, d), q = 3.0 * h * dot(a, d), r = h * dot(a, a) + dot(v, d),
               root = q * q - 4.0 * p * r;
  std::array<double, 4> ends{0.0, 0.0, 1.0, 1.0};
  if (p > 0.0 && root > 0.0) {
    ends[1] = std::clamp((-q - std::sqrt(root)) / (2.0 * p), 0.0, 1.0);
    ends[2] = std::clamp((-q + std::sqrt(root)) / (2.0 * p), 0.0, 1.0);
  }
  double peak = norm(v);
  for (std::size_t k = 1; k < ends.size(); ++k) {
    double low = ends[k - 1], high = ends[k];
    peak = std::max(peak, norm(velocity(high)));
    if (growth(low) <= 0.0 || growth(high) >= 0.0) continue;
    for (int n = 0; n < 50; ++n) {
      const double s = 0.5 * (low + high);
      (growth(s) > 0.0 ? low : high) = s;
    }
    peak = std::max(peak, norm(velocity(low)));
  }
  return peak;
}

}  // namespace

ShakingMeasures measure_along(Vec2 direction, const GroundMotion& motion, double scale, double duration) {
  std::vector<Vec2> part = motion.accelerations();
  for (Vec2& a : part) a = dot(a, direction) * direction;
  return measure(GroundMotion(motion.name(), motion.times(), std::move(part)), scale, duration);
}

ShakingMeasures measure(const GroundMotion& motion, double scale, double duration) {
  const std::vector<double>& t = motion.times();
  const std::vector<Vec2>& a = motion.accelerations();
  ShakingMeasures m;
  Vec2 velocity;
  double squares = 0.0;
  for (std::size_t k = 0; k < t.size() && t[k] <= duration; ++k) {
    m.peak = std::max(m.peak, norm(a[k]));
    if (k + 1 == t.size()) break;
    const double h = std::min(t[k + 1], duration) - t[k];
    if (h <= 0.0) continue;
    const Vec2 end = lerp(a[k], a[k + 1], h / (t[k + 1] - t[k]));
    m.peak = std::max(m.peak, norm(end));
    m.peak_velocity = std::max(m.peak_velocity, peak_velocity(velocity, a[k], end, h));
    velocity += 0.5 * h * (a[k] + end);
    squares += h / 3.0 * (dot(a[k], a[k]) + dot(a[k], end) + dot(end, end));
  }
  m.peak *= std::abs(scale);
  m.peak_velocity *= std::abs(scale);
  m.arias_intensity = std::numbers::pi / (2.0 * standard_gravity) * squares * scale * scale;
  return m;
}

double mean_period(const GroundMotion& motion) {
  const std::vector<double>& t = motion.times();
  const std::vector<Vec2>& a = motion.accelerations();
  double area = 0.0, way = 0.0;
  for (std::size_t k = 1; k < t.size(); ++k) {
    area += 0.5 * (t[k] - t[k - 1]) * (norm(a[k - 1]) + norm(a[k]));
    way += norm(a[k] - a[k - 1]);
  }
  return way > 0.0 ? 2.0 * std::numbers::pi * area / way : 0.0;
}

MotionMeasures measure(const MotionComponent& component) {
  const std::vector<double>& a = component.acceleration;
  MotionMeasures m;
  const std::size_t peak = component.peak_index();
  m.peak = a[peak];
  m.peak_time = component.time(peak);
  std::vector<double> squares{0.0};
  double velocity = 0.0;
  for (std::size_t k = 1; k < a.size(); ++k) {
    const double h = component.time(k) - component.time(k - 1);
    // Velocity is largest where acceleration passes through zero.
    if (a[k - 1] * a[k] < 0.0) {
      const double turn = velocity + 0.5 * h * a[k - 1] * a[k - 1] / (a[k - 1] - a[k]);
      m.peak_velocity = std::max(m.peak_velocity, std::abs(turn));
    }
    velocity += 0.5 * h * (a[k - 1] + a[k]);
    m.peak_velocity = std::max(m.peak_velocity, std::abs(velocity));
    m.absolute_velocity += a[k - 1] * a[k] < 0.0
                               ? 0.5 * h * (a[k - 1] * a[k - 1] + a[k] * a[k]) / std::abs(a[k] - a[k - 1])
                               : 0.5 * h * std::abs(a[k - 1] + a[k]);
    squares.push_back(squares.back() + h / 3.0 * (a[k - 1] * a[k - 1] + a[k - 1] * a[k] + a[k] * a[k]));
  }
  m.final_velocity = velocity;
  m.arias_intensity = std::numbers::pi / (2.0 * standard_gravity) * squares.back();
  if (squares.back() > 0.0) {
    m.significant_duration = time_of(component, squares, 0.95 * squares.back()) -
                             time_of(component, squares, 0.05 * squares.back());
  }
  return m;
}

namespace {

constexpr double least_jump = 0.05;  // of the peak

EndJumps jumps_of(double start, double end, double peak) {
  EndJumps jumps{std::abs(start), std::abs(end), peak};
  if (!(jumps.start > least_jump * peak)) jumps.start = 0.0;
  if (!(jumps.end > least_jump * peak)) jumps.end = 0.0;
  return jumps;
}

std::string unusual_peak(double peak) {
  const double in_g = std::abs(peak) / standard_gravity;
  if (in_g >= least_usual_peak && in_g <= most_usual_peak) return {};
  return fmt::format("the peak is {:.3g} g; usual is {} to {} g; is the unit right?", in_g, least_usual_peak,
                     most_usual_peak);
}

}  // namespace

EndJumps end_jumps(const GroundMotion& motion) {
  const std::vector<Vec2>& a = motion.accelerations();
  if (a.empty()) return {};
  return jumps_of(norm(a.front()), norm(a.back()), motion.peak());
}

EndJumps end_jumps(const MotionComponent& component) {
  const std::vector<double>& a = component.acceleration;
  return jumps_of(a.front(), a.back(), std::abs(a[component.peak_index()]));
}

std::string jumps_text(const EndJumps& jumps) {
  const auto part = [&](const char* verb, double jump) {
    return fmt::format("{} with a jump of {:.3g} m/s2, {:.0f} % of its peak", verb, jump,
                       100.0 * jump / jumps.peak);
  };
  if (jumps.start > 0.0 && jumps.end > 0.0)
    return part("starts", jumps.start) + ", and " + part("ends", jumps.end);
  if (jumps.start > 0.0) return part("starts", jumps.start);
  return jumps.end > 0.0 ? part("ends", jumps.end) : "";
}

MotionComponent cut_out(MotionComponent component, double from, double to) {
  constexpr double rounding = 1e-9;
  const double slack = rounding * component.duration();
  std::vector<double> times, samples;
  for (std::size_t k = 0; k < component.acceleration.size(); ++k) {
    const double t = component.time(k);
    if (t < from - slack || t > to + slack) continue;
    times.push_back(t);
    samples.push_back(component.acceleration[k]);
  }
  if (samples.size() < 2) {
    Diagnostic diagnostic;
    diagnostic.where.file = component.file;
    diagnostic.key = "window";
    diagnostic.found = fmt::format("[{}, {}]", from, to);
    diagnostic.expected =
        fmt::format("ascending times within the record, {} to {} s", component.time(0), component.end());
    throw InputError(std::move(diagnostic));
  }
  component.start = times.front();
  if (!component.times.empty()) component.times = std::move(times);
  component.acceleration = std::move(samples);
  return component;
}

namespace {

std::string describe_file(const MotionComponent& c) {
  std::string text = fmt::format("{}: {}\n", std::filesystem::path(c.file).filename().string(), c.format);
  if (!c.event.empty()) text += fmt::format("  event      {}\n", printable(c.event, longest_text));
  if (!c.station.empty()) text += fmt::format("  station    {}\n", printable(c.station, longest_text));
  return text;
}

std::string describe_component(const MotionComponent& c) {
  const MotionMeasures m = measure(c);
  const std::string step = c.times.empty() ? fmt::format("dt {:.6g} s", c.dt) : "uneven steps";
  std::string text =
      fmt::format("  component  {}{}\n", direction(c),
                  c.label.empty() ? "" : fmt::format("  ({})", printable(c.label, longest_text)));
  text +=
      fmt::format("    samples              {}, {}, {:.6g} s\n", c.acceleration.size(), step, c.duration());
  const std::string as_read =
      c.file_unit == "m/s2" ? "" : fmt::format("{:.6g} {} = ", m.peak / c.file_unit_in_si, c.file_unit);
  text += fmt::format("    peak acceleration    {}{:.4g} m/s2 = {:.3g} g at {:.6g} s\n", as_read, m.peak,
                      m.peak / standard_gravity, m.peak_time);
  text += fmt::format("    peak velocity        {:.4g} m/s (integrated from rest; {:.4f} m/s at the end)\n",
                      m.peak_velocity, m.final_velocity);
  text += fmt::format("    Arias intensity      {:.4g} m/s; 5-95 % duration {:.4g} s; CAV {:.4g} m/s\n",
                      m.arias_intensity, m.significant_duration, m.absolute_velocity);
  if (!c.processing.empty())
    text += fmt::format("    reading              {}\n", printable(c.processing, longest_text));
  for (const std::string& note : motion_notes(c)) text += fmt::format("    note                 {}\n", note);
  return text;
}

}  // namespace

std::vector<std::string> motion_notes(const MotionComponent& component) {
  std::vector<std::string> notes;
  const double peak = component.acceleration[component.peak_index()];
  for (const std::string& words : {unusual_peak(peak), jumps_text(end_jumps(component))}) {
    if (!words.empty()) notes.push_back(words);
  }
  notes.insert(notes.end(), component.notes.begin(), component.notes.end());
  return notes;
}

std::string describe_rotated(const std::vector<MotionComponent>& components) {
  const auto horizontal = horizontal_pair(components);
  if (!horizontal) return {};
  std::string text = "\nRotD50, RotD100 of the two horizontal components\n";
  for (const RotatedMeasure& m : rotated_measures(*horizontal))
    text += fmt::format("    {:<20} {:.4g}, {:.4g} {}\n", m.name, m.rotd50, m.rotd100, m.unit);
  return text;
}

std::string describe_motion(const std::vector<MotionComponent>& components) {
  std::string text;
  std::string file;
  for (const MotionComponent& c : components) {
    if (c.file != file) {
      file = c.file;
      text += (text.empty() ? "" : "\n") + describe_file(c);
    }
    text += describe_component(c);
  }
  return text + describe_rotated(components);
}

}  // namespace keyblock::loading
