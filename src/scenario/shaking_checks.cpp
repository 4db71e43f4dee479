#include "scenario/shaking_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "loading/motion_measures.h"
#include "record/stage.h"
#include "scenario/key_path.h"
#include "scenario/magnitudes.h"

namespace keyblock::scenario {
namespace {

constexpr double least_steps = 20.0;  // of the time integration in a period that it has to follow
constexpr double chords = 0.02;  // that a period falls short by, as accelerations go straight between samples
constexpr double rounding = 1e-6;  // of times in files

constexpr double slow = 1.0, fast = 10.0;  // Hz, that shake in any earthquake

using loading::GroundMotion;
using record::Stage;

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

/// g, horizontal in the section over the duration of a stage.
double horizontal_peak(const Stage& stage, const GroundMotion& motion, double scale) {
  const double duration = stage.duration.value_or(motion.duration());
  return loading::measure_along({1.0, 0.0}, motion, scale, duration).peak / loading::standard_gravity;
}

/// A sine or a table of less than 0.5 m/s² that would be an earthquake in g. Whether there is something to warn of.
bool warn_of_amplitude(const Scenario& scenario, const Stage& stage, const MotionSpec& spec,
                       const GroundMotion& motion, std::vector<std::string>& warnings) {
  if (!spec.components.empty() || spec.pga || spec.pgv || scenario.accepted.scale ||
      is_unusual(scenario, spec.path))
    return false;
  const double duration = stage.duration.value_or(motion.duration()),
               peak = loading::measure(motion, stage.scale, duration).peak;
  const std::string text = unusual_text(usual::shaking, peak);
  if (peak >= usual::shaking.least || text.find("was it in g?") == std::string::npos) return false;
  warnings.push_back(fmt::format("{}{}: shakes by at most {:.4g} m/s2 in the stage '{}'; {}", spec.path,
                                 place_text(scenario, spec.path), peak, stage.name, text));
  return true;
}

/// A factor below 1 that leaves little of a record, and would make more of it as a peak in g, or one on a sine, whose size is its amplitude; or
/// one that makes of it what no earthquake has, and would not in per cent. Empty: none of them.
std::string scale_text(const Stage& stage, const GroundMotion& motion, double scale, bool is_sine) {
  constexpr double least = 0.05, stronger = 1.5, weak = 0.1, percent = 100.0;
  const double recorded = horizontal_peak(stage, motion, 1.0), peak = scale * recorded;
  const bool is_less = scale >= least && scale < 1.0 && recorded > 0.0;
  if (is_less && (is_sine || (scale > stronger * recorded && peak < weak)))
    return fmt::format(
        "{:.4g} is a factor, and {:.3g} g of the {} in the section become {:.2g} g; for a peak of {:.4g} g "
        "take pga = {:.4g} (m/s2) of the motion, or scale = {:.3g}",
        scale, recorded, is_sine ? "sine" : "record", peak, scale, scale * loading::standard_gravity,
        scale / recorded);
  if (scale >= 10.0 && peak > loading::most_usual_peak)
    return fmt::format(
        "{:.4g} is a factor, and makes {:.3g} g of {:.3g} g in the section; was it in per cent? That is "
        "{:.4g}",
        scale, peak, recorded, scale / percent);
  return {};
}

/// Whether there is something to warn of.
bool warn_of_scale(const Scenario& scenario, const Stage& stage, const MotionSpec& spec,
                   const GroundMotion& motion, std::vector<std::string>& warnings) {
  const std::string text = scale_text(stage, motion, stage.scale, spec.sine_x || spec.sine_y);
  const std::string key = join_path(join_path("stage", stage.name), "scale");
  if (text.empty() || scenario.accepted.scale || is_unusual(scenario, key)) return false;
  warnings.push_back(fmt::format("{}{}: {}", key, place_text(scenario, key), text));
  return true;
}

void warn_of_window(const Scenario& scenario, const MotionSpec& spec, const GroundMotion& motion,
                    std::vector<std::string>& warnings) {
  constexpr double enough = 0.5;
  const std::string key = join_path(spec.path, "window");
  if (motion.share_of_record() >= enough || !spec.window || scenario.accepted.window) return;
  warnings.push_back(fmt::format(
      "{}{}: {:.4g} to {:.4g} s have {:.2g} % of the Arias intensity of the record; the strong part "
      "of the shaking is left out",
      key, place_text(scenario, key), spec.window->first, spec.window->second,
      100.0 * motion.share_of_record()));
}

void warn_of_peak(const Scenario& scenario, const Stage& stage, const MotionSpec& spec,
                  const GroundMotion& motion, std::vector<std::string>& warnings) {
  if (stage.scale == 0.0 || is_unusual(scenario, spec.path)) return;
  const double duration = stage.duration.value_or(motion.duration()),
               peak = loading::measure(motion, stage.scale, duration).peak,
               in_g = peak / loading::standard_gravity;
  if (in_g >= loading::least_usual_peak && in_g <= loading::most_usual_peak) return;
  const std::string of_scale = join_path(join_path("stage", stage.name), "scale");
  if (in_g > loading::most_usual_peak && is_unusual(scenario, of_scale)) return;
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
    is_dynamic |= stage.kind != record::StageKind::settle;
    if (stage.kind != record::StageKind::shake) continue;
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
    if (times[k] <= end * (1.0 + rounding)) before += part;
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

/// The first of the values that seems to be a peak, or a per cent.
void warn_of_values(const Stage& stage, const GroundMotion& motion, const VarySpec& axis, std::size_t key,
                    std::vector<std::string>& warnings) {
  constexpr double most_in_g = 1.5;
  std::vector<double> scales;
  for (const auto& values : axis.values) std::istringstream(values[key]) >> scales.emplace_back(0.0);
  const bool is_in_g = *std::ranges::max_element(scales) <= most_in_g;
  for (const double scale : scales) {
    const std::string text = scale_text(stage, motion, scale, false);
    if (text.empty() || (scale < 1.0 && !is_in_g)) continue;
    warnings.push_back(fmt::format("study.vary: {}: {}", axis.keys[key], text));
    return;
  }
}

}  // namespace

const Stage* stage_of_scale(const Scenario& scenario, const std::string& key) {
  const auto path = parse_key_path(key);
  if (!path || path->size() != 3 || path->front().key != "stage" || path->back().key != "scale")
    return nullptr;
  const auto stage = std::ranges::find(scenario.stages, (*path)[1].key, &Stage::name);
  return stage == scenario.stages.end() || stage->kind != record::StageKind::shake ? nullptr : &*stage;
}

void add_shaking_warnings(const Scenario& scenario, const std::vector<GroundMotion>& motions,
                          std::vector<std::string>& warnings) {
  std::vector<bool> seen(motions.size(), false);
  for (const Stage& stage : scenario.stages) {
    if (stage.kind != record::StageKind::shake) continue;
    const auto k = static_cast<std::size_t>(stage.motion);
    if (!scenario.accepted.step && !seen[k])
      warn_of_step(scenario, scenario.motions[k], motions[k], warnings);
    if (!seen[k]) warn_of_window(scenario, scenario.motions[k], motions[k], warnings);
    seen[k] = true;
    warn_of_short_stage(stage, motions[k], warnings);
    if (!scenario.si_units) continue;
    const MotionSpec& spec = scenario.motions[k];
    if (!warn_of_scale(scenario, stage, spec, motions[k], warnings) &&
        !warn_of_amplitude(scenario, stage, spec, motions[k], warnings))
      warn_of_peak(scenario, stage, spec, motions[k], warnings);
  }
  warn_of_damping(scenario, motions, warnings);
}

std::vector<GroundFact> earthquake_facts(const Scenario& scenario, const std::vector<GroundMotion>& motions) {
  std::vector<GroundFact> facts;
  const auto shakes = [](const Stage& s) { return s.kind == record::StageKind::shake; };
  const bool several = std::ranges::count_if(scenario.stages, shakes) > 1;
  for (const Stage& stage : scenario.stages) {
    if (!shakes(stage)) continue;
    const GroundMotion& motion = motions[static_cast<std::size_t>(stage.motion)];
    const double duration = stage.duration.value_or(motion.duration()),
                 vertical = loading::measure_along({0.0, 1.0}, motion, stage.scale, duration).peak /
                            loading::standard_gravity,
                 share = motion.share_of_record() * share_of_shaking(motion, duration);
    std::string text =
        fmt::format("{:.2g} g horizontal in the section", horizontal_peak(stage, motion, stage.scale));
    if (vertical > 0.0) text += fmt::format(", {:.2g} g vertical", vertical);
    if (!scenario.motions[static_cast<std::size_t>(stage.motion)].components.empty() || share < 1.0)
      text += fmt::format(", {:.3g} % of the Arias intensity in the window", 100.0 * share);
    facts.push_back(
        {several ? fmt::format("earthquake of “{}”", stage.name) : "earthquake", std::move(text)});
  }
  return facts;
}

void add_study_scale_warnings(const Scenario& scenario, const std::vector<GroundMotion>& motions,
                              std::vector<std::string>& warnings) {
  if (!scenario.study || !scenario.si_units || scenario.accepted.scale) return;
  for (const VarySpec& axis : scenario.study->vary) {
    for (std::size_t j = 0; j < axis.keys.size(); ++j) {
      const Stage* stage = stage_of_scale(scenario, axis.keys[j]);
      if (stage != nullptr)
        warn_of_values(*stage, motions[static_cast<std::size_t>(stage->motion)], axis, j, warnings);
    }
  }
}

}  // namespace keyblock::scenario
