#include "loading/projection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace keyblock::loading {
namespace {

// Sample times of components that differ by less than this share of the smallest step are the same time.
constexpr double same_time_tolerance = 1e-6;
constexpr double taper_share = 0.05;  // of the window, at each end
constexpr int sine_rows_per_cycle = 1000;
constexpr double most_sine_rows = 1e7;

// A function of time that is linear between its nodes and zero outside them; two nodes of one time are a
// jump.
struct Curve {
  std::vector<double> time;
  std::vector<double> value;
  Vec2 direction;  // what value 1 adds to (a_x, a_y)

  // Limits at t from either side.
  [[nodiscard]] double left(double t) const {
    const auto next = static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), t) - time.begin());
    return next == 0 || next == time.size() ? 0.0 : between(next, t);
  }
  [[nodiscard]] double right(double t) const {
    const auto next = static_cast<std::size_t>(std::upper_bound(time.begin(), time.end(), t) - time.begin());
    return next == 0 || next == time.size() ? 0.0 : between(next, t);
  }
  [[nodiscard]] double between(std::size_t next, double t) const {
    const double s = (t - time[next - 1]) / (time[next] - time[next - 1]);
    return (1.0 - s) * value[next - 1] + s * value[next];
  }
};

struct Samples {
  std::vector<double> time;
  std::vector<Vec2> value;
};

[[noreturn]] void fail(std::string key, std::string found, std::string expected, std::string hint = {}) {
  Diagnostic diagnostic;
  diagnostic.key = std::move(key);
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

// Sorted times of all curves without near-duplicates, to which the curves' own times are then moved.
std::vector<double> common_times(std::vector<Curve>& curves) {
  std::vector<double> times;
  double smallest_step = HUGE_VAL;
  for (const Curve& curve : curves) {
    times.insert(times.end(), curve.time.begin(), curve.time.end());
    for (std::size_t k = 1; k < curve.time.size(); ++k) {
      const double step = curve.time[k] - curve.time[k - 1];
      if (step > 0.0) smallest_step = std::min(smallest_step, step);
    }
  }
  const double tolerance = std::isfinite(smallest_step) ? same_time_tolerance * smallest_step : 0.0;
  std::sort(times.begin(), times.end());
  times.erase(
      std::unique(times.begin(), times.end(), [&](double kept, double t) { return t - kept <= tolerance; }),
      times.end());
  for (Curve& curve : curves) {
    for (double& t : curve.time) t = *(std::upper_bound(times.begin(), times.end(), t) - 1);
  }
  return times;
}

Samples sum(std::vector<Curve>& curves) {
  Samples samples;
  for (const double t : common_times(curves)) {
    Vec2 left, right;
    for (const Curve& curve : curves) {
      left += curve.left(t) * curve.direction;
      right += curve.right(t) * curve.direction;
    }
    samples.time.push_back(t);
    samples.value.push_back(left);
    if (right == left) continue;
    samples.time.push_back(t);
    samples.value.push_back(right);
  }
  return samples;
}

// The part in [t0, t1], with time restarting at 0. Jumps at the very ends are left out.
Samples cut(const Samples& all, double t0, double t1) {
  const auto value = [&](std::size_t next, double t) {
    return lerp(all.value[next - 1], all.value[next],
                (t - all.time[next - 1]) / (all.time[next] - all.time[next - 1]));
  };
  const auto first =
      static_cast<std::size_t>(std::upper_bound(all.time.begin(), all.time.end(), t0) - all.time.begin());
  const auto last =
      static_cast<std::size_t>(std::lower_bound(all.time.begin(), all.time.end(), t1) - all.time.begin());
  Samples part{{0.0}, {value(first, t0)}};
  for (std::size_t k = first; k < last; ++k) {
    part.time.push_back(all.time[k] - t0);
    part.value.push_back(all.value[k]);
  }
  part.time.push_back(t1 - t0);
  part.value.push_back(value(last, t1));
  return part;
}

// ∫|a|² dt.
double square_integral(const Samples& s) {
  double squares = 0.0;
  for (std::size_t k = 1; k < s.time.size(); ++k) {
    const Vec2 a = s.value[k - 1], b = s.value[k];
    squares += (s.time[k] - s.time[k - 1]) / 3.0 * (dot(a, a) + dot(a, b) + dot(b, b));
  }
  return squares;
}

// ∫a dt and ∫∫a dt dt over the whole of a piecewise linear function.
std::pair<Vec2, Vec2> final_motion(const Samples& s) {
  Vec2 velocity, displacement;
  for (std::size_t k = 1; k < s.time.size(); ++k) {
    const double h = s.time[k] - s.time[k - 1];
    displacement += h * velocity + h * h / 6.0 * (2.0 * s.value[k - 1] + s.value[k]);
    velocity += 0.5 * h * (s.value[k - 1] + s.value[k]);
  }
  return {velocity, displacement};
}

void correct(Samples& s, Baseline baseline) {
  const double duration = s.time.back();
  const auto [velocity, displacement] = final_motion(s);
  // With c(t) = c0 + c1 t: velocity c0 T + c1 T²/2, displacement c0 T²/2 + c1 T³/6.
  Vec2 c0, c1;
  if (baseline == Baseline::demean) c0 = velocity / duration;
  if (baseline == Baseline::linear) {
    c1 = 6.0 / (duration * duration) * (velocity - 2.0 / duration * displacement);
    c0 = velocity / duration - 0.5 * duration * c1;
  }
  const double ramp = taper_share * duration;
  for (std::size_t k = 0; k < s.time.size(); ++k) {
    const double t = s.time[k];
    s.value[k] -= c0 + t * c1;
    const double from_end = std::min(t, duration - t);
    if (baseline == Baseline::taper && from_end < ramp) {
      s.value[k] = 0.5 * (1.0 - std::cos(std::numbers::pi * from_end / ramp)) * s.value[k];
    }
  }
}

Curve component_curve(const MotionComponent& component, const ComponentDirection& direction,
                      double section_azimuth) {
  const std::size_t n = component.acceleration.size();
  Curve curve;
  const double first_step = n > 1 ? component.time(1) - component.time(0) : component.dt;
  const double last_step = n > 1 ? component.time(n - 1) - component.time(n - 2) : component.dt;
  curve.time.push_back(component.time(0) - first_step);
  curve.value.push_back(0.0);
  for (std::size_t k = 0; k < n; ++k) {
    curve.time.push_back(component.time(k));
    curve.value.push_back(component.acceleration[k]);
  }
  curve.time.push_back(component.time(n - 1) + last_step);
  curve.value.push_back(0.0);
  // An angle in degrees that is a multiple of 90 must give 0 and 1 exactly.
  const double angle = std::remainder(direction.azimuth - section_azimuth, 360.0);
  const double cosine = std::abs(angle) == 90.0 ? 0.0 : std::cos(angle * std::numbers::pi / 180.0);
  curve.direction = direction.vertical ? Vec2{0.0, 1.0} : Vec2{cosine, 0.0};
  return curve;
}

Curve table_curve(const AccelerationTable& table, Vec2 direction, const char* key) {
  Curve curve;
  curve.direction = direction;
  for (const auto& [time, value] : table) {
    const std::string row = fmt::format("row {}: [{}, {}]", curve.time.size() + 1, time, value);
    if (!std::isfinite(time) || !std::isfinite(value)) fail(key, row, "finite numbers");
    if (time < 0.0) fail(key, row, "times from 0 on");
    if (!curve.time.empty() && time < curve.time.back()) fail(key, row, "rows that ascend in time");
    curve.time.push_back(time);
    curve.value.push_back(value);
  }
  return curve;
}

}  // namespace

GroundMotion project_motion(std::string name,
                            const std::vector<std::pair<MotionComponent, ComponentDirection>>& components,
                            const ProjectionOptions& options) {
  if (components.empty()) fail("components", "none", "at least one component");
  std::vector<Curve> curves;
  double start = HUGE_VAL, end = -HUGE_VAL;
  for (const auto& [component, direction] : components) {
    if (component.acceleration.empty()) fail("components", component.file + " without samples", "samples");
    curves.push_back(component_curve(component, direction, options.section_azimuth));
    start = std::min(start, component.time(0));
    end = std::max(end, component.end());
  }
  if (!(start < end)) {
    fail("components", components.front().first.file + " of one sample", "records of two samples or more");
  }
  const auto [t0, t1] = options.window.value_or(std::pair{start, end});
  const double slack = 1e-9 * (end - start);  // for a window typed from rounded times
  if (!(t0 < t1) || t0 < start - slack || t1 > end + slack) {
    fail("window", fmt::format("[{}, {}]", t0, t1),
         fmt::format("ascending times within the record, {} to {} s", start, end));
  }
  const Samples record = sum(curves);
  const double whole = square_integral(record);
  Samples samples = cut(record, t0, t1);
  const double share = whole > 0.0 ? square_integral(samples) / whole : 1.0;
  if (options.baseline != Baseline::none) correct(samples, options.baseline);
  for (Vec2& a : samples.value) a = options.scale * a;
  GroundMotion motion(std::move(name), std::move(samples.time), std::move(samples.value));
  motion.set_share_of_record(share);
  return motion;
}

AccelerationTable sine_table(const Sine& sine) {
  if (!(sine.frequency > 0.0) || !std::isfinite(sine.frequency)) {
    fail("frequency", fmt::format("{}", sine.frequency), "a frequency above 0 Hz");
  }
  if (!(sine.cycles > 0.0) || !(sine.cycles * sine_rows_per_cycle <= most_sine_rows)) {
    fail("cycles", fmt::format("{}", sine.cycles),
         fmt::format("above 0, at most {}", most_sine_rows / sine_rows_per_cycle));
  }
  if (!std::isfinite(sine.amplitude))
    fail("amplitude", fmt::format("{}", sine.amplitude), "a finite acceleration");
  const double end = sine.cycles / sine.frequency;
  AccelerationTable table;
  // Phase in thousandths of a cycle, reduced before the sine is taken: the same digits in every cycle.
  for (int k = 0; k < sine.cycles * sine_rows_per_cycle; ++k) {
    const double phase = static_cast<double>(k % sine_rows_per_cycle) / sine_rows_per_cycle;
    table.emplace_back(static_cast<double>(k) / sine_rows_per_cycle / sine.frequency,
                       phase == 0.5 ? 0.0 : sine.amplitude * std::sin(2.0 * std::numbers::pi * phase));
  }
  const double rest = sine.cycles - std::floor(sine.cycles);
  table.emplace_back(
      end, rest == 0.0 || rest == 0.5 ? 0.0 : sine.amplitude * std::sin(2.0 * std::numbers::pi * rest));
  return table;
}

GroundMotion table_motion(std::string name, const AccelerationTable& x, const AccelerationTable& y) {
  std::vector<Curve> curves{table_curve(x, {1.0, 0.0}, "x"), table_curve(y, {0.0, 1.0}, "y")};
  std::erase_if(curves, [](const Curve& curve) { return curve.time.empty(); });
  double end = 0.0;
  for (const Curve& curve : curves) end = std::max(end, curve.time.back());
  if (!(end > 0.0)) fail("x", "no table or sine of any duration in x or y", "rows [[time, acceleration], …]");
  // The start and the end of the motion are times of their own, though a table starts later.
  curves.push_back({{0.0, end}, {0.0, 0.0}, {}});
  Samples samples = cut(sum(curves), 0.0, end);
  return {std::move(name), std::move(samples.time), std::move(samples.value)};
}

}  // namespace keyblock::loading
