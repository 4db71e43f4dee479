#include "scenario/shaking_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "loading/motion_measures.h"
#include "scenario/key_path.h"
#include "scenario/magnitudes.h"
#include "simulation/stage.h"

namespace keyblock::scenario {
namespace {

constexpr double least_steps = 20.0;  // of the time integration in a period that it has to follow
constexpr double chords = 0.02;  // that a period falls short by, as accelerations go straight between samples
constexpr double rounding = 1e-6;  // of times in files

constexpr double slow = 1.0, fast = 10.0;  // Hz, that shake in any earthquake

using loading::GroundMotion;
using simulation::Stage;

/// s between the samples of a record, in the median; 0 where there are none.
double sampling_step(const GroundMotion& motion) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < motion.times().size(); ++k) {
    const double step = motion.times()[k] - motion.times()[k - 1];
    if (step > 0.0) steps.push_back(step);
  }
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

void warn_of_step(const Scenario& scenario, const MotionSpec& spec, const GroundMotion& motion,
                  std::vector<std::string>& warnings) {
  const double step = scenario.time_step, period = loading::mean_period(motion);
  const std::string head = fmt::format("time.step = {:.4g} s{}: ", step, place_text(scenario, "time.step"));
  if (const double sampling = spec.components.empty() ? 0.0 : sampling_step(motion);
      sampling > 0.0 && step > (1.0 + rounding) * sampling) {
    warnings.push_back(fmt::format(
        "{}longer than the step of the record of {}, {:.4g} s; what is faster than {:.4g} s is lost", head,
        spec.path, sampling, 2.0 * step));
  }
  if (period > 0.0 && period < (1.0 - chords) * least_steps * step) {
    warnings.push_back(
        fmt::format("{}{} swings with a period of about {:.3g} s, which is {:.2g} steps; usual is at "
                    "least {} steps, {:.2g} s",
                    head, spec.path, period, period / step, least_steps, period / least_steps));
  }
}

/// Why the peak of a motion is smaller than any that shakes.
std::string reason_of_small_peak(const Scenario& scenario, const MotionSpec& spec) {
  const char* units = "is the record in g, and was read as m/s2 or cm/s2?";
  if (spec.components.empty() || !scenario.section_azimuth) return units;
  return fmt::format("is section.azimuth = {:.4g}{} normal to the motion, or {}", *scenario.section_azimuth,
                     place_text(scenario, "section.azimuth"), units);
}

void warn_of_peak(const Scenario& scenario, const Stage& stage, const MotionSpec& spec,
                  const GroundMotion& motion, std::vector<std::string>& warnings) {
  if (stage.scale == 0.0) return;
  const double duration = stage.duration.value_or(motion.duration()),
               peak = loading::measure(motion, stage.scale, duration).peak,
               in_g = peak / loading::standard_gravity;
  if (in_g >= loading::least_usual_peak && in_g <= loading::most_usual_peak) return;
  warnings.push_back(
      fmt::format("{}: the peak acceleration of {} is {:.4g} m/s2, {:.3g} g, with scale = {:.4g}; usual is "
                  "{} to {} g; {}",
                  join_path("stage", stage.name), spec.path, peak, in_g, stage.scale,
                  loading::least_usual_peak, loading::most_usual_peak,
                  in_g > loading::most_usual_peak ? "is the record in cm/s2, and was read as m/s2 or g?"
                                                  : reason_of_small_peak(scenario, spec)));
}

/// Hz, between which damping is less than critical: the roots of ½ (α/ω + β ω) = 1.
std::pair<double, double> swinging(const dynamics::RayleighDamping& damping) {
  const double alpha = damping.mass_rate(), beta = damping.stiffness_time(),
               sum = 1.0 + std::sqrt(1.0 - alpha * beta), turn = 2.0 * std::numbers::pi;
  return {alpha / sum / turn, beta > 0.0 ? sum / beta / turn : HUGE_VAL};
}

/// Where the motions of stages, and what any earthquake has, would not swing.
void warn_of_damping(const Scenario& scenario, const std::vector<GroundMotion>& motions,
                     std::vector<std::string>& warnings) {
  if (!scenario.solver.damping || scenario.accepted.damping) return;
  double least = slow, most = fast;
  bool is_dynamic = false;
  for (const Stage& stage : scenario.stages) {
    is_dynamic |= stage.kind != simulation::StageKind::settle;
    if (stage.kind != simulation::StageKind::shake) continue;
    const double period = loading::mean_period(motions[static_cast<std::size_t>(stage.motion)]);
    if (period <= 0.0) continue;
    least = std::min(least, 1.0 / period);
    most = std::max(most, 1.0 / period);
  }
  const auto& damping = *scenario.solver.damping;
  const auto [from, to] = swinging(damping);
  const bool is_fast = to < most;
  if (!is_dynamic || (!is_fast && from <= least)) return;
  const double worst = is_fast ? most : least;
  warnings.push_back(fmt::format(
      "solver.damping{}: a ratio of {:.4g} at {:.4g} Hz is more than critical {} {:.3g} Hz, {:.3g} "
      "times at {:.3g} Hz; what moves there creeps back and does not swing{}",
      place_text(scenario, "solver.damping"), damping.ratio, damping.frequency, is_fast ? "above" : "below",
      is_fast ? to : from, damping.ratio_at(worst), worst, is_fast ? ", and steps take long" : ""));
}

/// Of ∫|a|² dt, what is over at a time.
double share_of_shaking(const GroundMotion& motion, double end) {
  const std::vector<double>& times = motion.times();
  const std::vector<Vec2>& a = motion.accelerations();
  double before = 0.0, all = 0.0;
  for (std::size_t k = 1; k < times.size(); ++k) {
    const double part = 0.5 * (squared_norm(a[k - 1]) + squared_norm(a[k])) * (times[k] - times[k - 1]);
    all += part;
    if (times[k] <= end) before += part;
  }
  return all > 0.0 ? before / all : 1.0;
}

/// A stage that ends before half of the shaking.
void warn_of_short_stage(const Stage& stage, const GroundMotion& motion, std::vector<std::string>& warnings) {
  constexpr double enough = 0.5;
  if (!stage.duration || *stage.duration >= motion.duration()) return;
  const double share = share_of_shaking(motion, *stage.duration);
  if (share < enough)
    warnings.push_back(fmt::format(
        "{}.duration: {:.4g} s of the {:.4g} s of '{}', with {:.2g} % of its Arias intensity; the rest of "
        "the shaking is left out",
        join_path("stage", stage.name), *stage.duration, motion.duration(), motion.name(), 100.0 * share));
}

}  // namespace

void add_shaking_warnings(const Scenario& scenario, const std::vector<GroundMotion>& motions,
                          std::vector<std::string>& warnings) {
  std::vector<bool> seen(motions.size(), false);
  for (const Stage& stage : scenario.stages) {
    if (stage.kind != simulation::StageKind::shake) continue;
    const auto k = static_cast<std::size_t>(stage.motion);
    if (!scenario.accepted.step && !seen[k])
      warn_of_step(scenario, scenario.motions[k], motions[k], warnings);
    seen[k] = true;
    warn_of_short_stage(stage, motions[k], warnings);
    if (scenario.si_units) warn_of_peak(scenario, stage, scenario.motions[k], motions[k], warnings);
  }
  warn_of_damping(scenario, motions, warnings);
}

}  // namespace keyblock::scenario
