#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "rockmass/distribution.h"
#include "rockmass/intensity.h"
#include "scenario/build.h"
#include "scenario/ground_checks.h"
#include "scenario/inputs.h"
#include "scenario/joint_table.h"
#include "scenario/joint_warnings.h"
#include "scenario/key_path.h"
#include "scenario/load_checks.h"
#include "scenario/magnitudes.h"
#include "scenario/sections.h"
#include "scenario/shaking_checks.h"
#include "scenario/strength_checks.h"
#include "scenario/water_checks.h"
#include "simulation/base.h"

namespace keyblock::scenario {
namespace {

using record::Stage;
using record::StageKind;

// Cutting off a distribution that moves its mean by more than this share is worth a warning.
constexpr double mean_tolerance = 0.01;

class Plausibility {
 public:
  explicit Plausibility(const Scenario& scenario) : scenario_(scenario) {}

  std::vector<std::string> rock_mass_warnings() {
    add_skipped(scenario_.skipped);
    check_distributions();
    check_outlines();
    return std::move(warnings_);
  }

  std::vector<std::string> warnings() {
    add_skipped(scenario_.skipped);
    add_magnitude_warnings(scenario_, warnings_);
    check_distributions();
    add_strength_warnings(scenario_, warnings_);
    check_outlines();
    check_fall_distance();
    check_automatic_order();
    check_excavated();
    check_in_situ();
    check_plane_state();
    check_stages();
    check_release();
    check_velocities();
    check_base();
    check_gravity();
    check_tolerances();
    check_sizes();
    add_load_warnings(scenario_, warnings_);
    add_water_warnings(scenario_, warnings_);
    add_ground_warnings(scenario_, warnings_);
    return std::move(warnings_);
  }

 private:
  void add_skipped(const std::vector<std::string>& skipped) {
    if (!scenario_.accepted.skipped) warnings_.insert(warnings_.end(), skipped.begin(), skipped.end());
  }

  template <class... Values>
  void warn(fmt::format_string<Values...> text, Values&&... values) {
    warnings_.push_back(fmt::format(text, std::forward<Values>(values)...));
  }

  // A stage that settles sets every velocity to zero.
  void check_velocities() {
    if (scenario_.stages.empty() || scenario_.stages.front().kind != StageKind::settle) return;
    for (const BlockSpec& block : scenario_.blocks) {
      if (block.velocity == Vec2{} && block.spin == 0.0) continue;
      warn("{}.{}: is lost, as the first stage settles", block.path,
           block.velocity == Vec2{} ? "spin" : "velocity");
    }
  }

  void check_base() {
    const loading::TimeTable still;
    std::vector<simulation::FixedMotion> fixed;
    if (scenario_.domain && scenario_.domain->frame) fixed.push_back({still, still});
    for (const BlockSpec& block : scenario_.blocks)
      if (block.fixed) fixed.push_back({block.motion_x, block.motion_y});
    if (!simulation::move_alike(fixed))
      warn("block: fixed blocks move differently; damage is counted in space, not against one of them");
  }

  void check_distributions() {
    for (const JointSetSpec& spec : scenario_.joint_sets) {
      const std::pair<const char*, const rockmass::Distribution*> lengths[] = {
          {"spacing", &spec.set.spacing}, {"length", &spec.set.length}, {"gap", &spec.set.gap}};
      for (const auto& [key, distribution] : lengths) {
        if (distribution->mean <= 0.0) continue;
        const double mean = rockmass::truncated_mean(*distribution);
        if (!(mean > (1.0 + mean_tolerance) * distribution->mean)) continue;
        warn("{}.{}: cut off at zero, its mean is {:.4g} instead of {:.4g}", spec.path, key, mean,
             distribution->mean);
      }
      check_strengths(spec.path, spec.joints);
    }
    for (const TraceMapSpec& spec : scenario_.trace_maps) check_strengths(spec.path, spec.joints);
  }

  void check_strengths(const std::string& path, const JointKeys& joints) {
    for (std::size_t k = 0; k < rockmass::strength_count; ++k) {
      if (!joints.random[k] || joints.random[k]->distribution.mean <= 0.0) continue;
      const double mean = joints.random[k]->truncated_mean(), asked = joints.random[k]->distribution.mean;
      if (std::abs(mean - asked) > mean_tolerance * asked)
        warn("{}.{}: cut off at {:.4g} and {:.4g}, its mean is {:.4g} instead of {:.4g}", path,
             rockmass::strength_names[k], joints.random[k]->min, joints.random[k]->max, mean, asked);
    }
  }

  void check_automatic_order() {
    if (!scenario_.positions.contains("auto_order")) return;
    const auto is_automatic = [](const auto& spec) { return spec.rock.order == automatic_order; };
    if (scenario_.rock.order == automatic_order ||
        std::any_of(scenario_.regions.begin(), scenario_.regions.end(), is_automatic) ||
        std::any_of(scenario_.blocks.begin(), scenario_.blocks.end(), is_automatic))
      return;
    warn("auto_order: is not used, as no order is \"auto\"");
  }

  // As a tilt it is at most 45°: `tilt` turns it farther, and says so.
  void check_gravity() {
    const Vec2 g = scenario_.gravity;
    if (scenario_.positions.contains("tilt") || norm(g) == 0.0) return;
    if (g.y > 0.0) {
      warn("gravity = [{}, {}]{}: pulls upwards", g.x, g.y, place_text(scenario_, "gravity"));
    } else if (std::abs(g.x) > -g.y) {
      warn("gravity = [{}, {}]{}: pulls sideways more than downwards", g.x, g.y,
           place_text(scenario_, "gravity"));
    }
  }

  // Blocks that lack a per cent of their weight move, and are said to stand.
  void check_tolerances() {
    constexpr double loose = 1e-3;
    for (const Stage& stage : scenario_.stages) {
      const std::string key = join_path(join_path("stage", stage.name), "tolerance");
      if (stage.kind == StageKind::settle && stage.tolerance > loose)
        warn(
            "{} = {}{}: blocks that lack so much of their weight are said to be in equilibrium, and limits "
            "come out too high; "
            "usual is at most {}",
            key, stage.tolerance, place_text(scenario_, key), loose);
    }
  }

  // One of the blocks that are given is far larger or smaller than all others.
  void check_sizes() {
    constexpr double far = 100.0;
    std::vector<double> sizes;  // m
    for (const BlockSpec& block : scenario_.blocks) sizes.push_back(std::sqrt(area(block.polygon)));
    if (sizes.size() < 3) return;
    std::vector<double> sorted = sizes;
    std::ranges::sort(sorted);
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const bool is_large = sizes[k] == sorted.back() && sizes[k] > far * sorted[sorted.size() - 2],
                 is_small = sizes[k] == sorted.front() && far * sizes[k] < sorted[1];
      if (is_large || is_small)
        warn("{}.outer: a block of {:.2g} m among others of {:.2g} to {:.2g} m; is it in another unit?",
             scenario_.blocks[k].path, sizes[k], sorted[is_small ? 1 : 0],
             sorted[sorted.size() - (is_large ? 2 : 1)]);
    }
  }

  void check_excavated() {
    for (std::size_t k = 0; k < scenario_.excavations.size(); ++k) {
      const ExcavationSpec& spec = scenario_.excavations[k];
      const int index = static_cast<int>(k);
      const auto takes_out = [&](const Stage& stage) {
        return std::ranges::find(stage.excavate, index) != stage.excavate.end();
      };
      if (!any_stage(takes_out) && !scenario_.stages.empty()) warn("{}: no stage excavates it", spec.path);
    }
  }

  void check_outlines() {
    if (!scenario_.domain) return;
    const Box box = scenario_.domain->box();
    for (const ExcavationSpec& spec : scenario_.excavations) {
      const Ring outline = excavation_outline(spec);
      if (!std::all_of(outline.begin(), outline.end(), [&](Vec2 p) { return box.contains(p); })) {
        warn("{}: reaches beyond the domain", spec.path);
      }
    }
  }

  // What falls into an opening comes to lie on its floor.
  void check_fall_distance() {
    const double g = norm(scenario_.gravity);
    if (!scenario_.damage.fall_distance || scenario_.excavations.empty() || g == 0.0) return;
    double highest = -HUGE_VAL, lowest = HUGE_VAL;
    for (const ExcavationSpec& spec : scenario_.excavations) {
      for (const Vec2 p : excavation_outline(spec)) {
        const double height = -dot(p, scenario_.gravity) / g;
        highest = std::max(highest, height);
        lowest = std::min(lowest, height);
      }
    }
    if (*scenario_.damage.fall_distance >= highest - lowest)
      warn(
          "damage.fall_distance = {} m{}: openings are {:.4g} m high, and what falls into them does not "
          "count "
          "as fallen",
          *scenario_.damage.fall_distance, place_text(scenario_, "damage.fall_distance"), highest - lowest);
  }

  void check_in_situ() {
    if (!scenario_.in_situ) return;
    const InSituSpec& in_situ = *scenario_.in_situ;
    if (in_situ.k0 && 3.0 * *in_situ.k0 < 1.0) {
      warn("in_situ.k0 = {}: below 1/3 the crown of a round opening is not compressed (3 K0 < 1)",
           *in_situ.k0);
    }
    if (in_situ.depth) check_density_at_depth();
    if (!in_situ.depth && (in_situ.sxx > 0.0 || in_situ.syy > 0.0)) {
      warn("in_situ: a positive stress is tension");
    }
    if (scenario_.domain && !scenario_.domain->frame && !scenario_.boundary &&
        !scenario_.accepted.free_boundary) {
      warn(
          "in_situ{}: nothing holds the stress at a free boundary{}, and the rock expands as the run begins; "
          "boundary = \"frame\" holds it",
          place_text(scenario_, "in_situ"), place_text(scenario_, "domain.boundary"));
    }
  }

  // The rock cannot move along a long tunnel.
  void check_plane_state() {
    if (scenario_.excavations.empty() || scenario_.rock.state != block::PlaneState::plane_stress) return;
    if (scenario_.accepted.plane_stress) return;
    warn(
        "rock.state{}: plane stress{} with an excavation is a thin slab; a long tunnel is in plane strain, "
        "state = "
        "\"plane-strain\"",
        place_text(scenario_, "rock.state"),
        scenario_.positions.contains("rock.state") ? "" : ", the default,");
  }

  void check_density_at_depth() {
    const double assumed = *scenario_.rock.density;
    const auto check = [&](const std::string& path, const RockKeys& rock) {
      if (rock.density.value_or(assumed) == assumed) return;
      warn(
          "in_situ.depth: counts on the density of [rock], {} kg/m3, everywhere, but {} has {} kg/m3: its "
          "stress "
          "is not in balance before a stage settles; sxx, syy and sxy in place of depth and k0 are taken as "
          "they are",
          assumed, path, *rock.density);
    };
    for (std::size_t k = 0; k < scenario_.regions.size(); ++k)
      check(join_index("region", k), scenario_.regions[k].rock);
    for (const BlockSpec& block : scenario_.blocks) {
      if (!block.fixed) check(block.path, block.rock);
    }
  }

  void check_stages() {
    if (scenario_.stages.empty()) {
      warn("no [[stage]]: there is nothing to run, only to cut");
      return;
    }
    // Since the last excavation; at the start rock that fills a domain or is under stress has not.
    bool settled = !scenario_.domain && !scenario_.in_situ;
    bool excavated = false;
    const Stage* before = nullptr;
    for (const Stage& stage : scenario_.stages) {
      const std::string path = join_path("stage", stage.name);
      if (!stage.excavate.empty()) {
        settled = false;
        excavated = true;
      }
      if (stage.kind == StageKind::settle) settled = true;
      if (stage.kind == StageKind::shake && !settled) {
        warn("{}: shakes before the rock has settled{}", path, excavated ? " after an excavation" : "");
      } else if (stage.kind == StageKind::shake && before != nullptr) {
        check_late_falls(path, *before);
      }
      before = &stage;
    }
    for (const MotionSpec& motion : scenario_.motions) {
      const int index = static_cast<int>(&motion - scenario_.motions.data());
      const auto uses = [&](const Stage& stage) { return stage.motion == index; };
      if (motion.suite < 0 && !any_stage(uses) && !is_varied(motion))
        warn("{}: no stage uses it", motion.path);
    }
  }

  /// Whether a study gives it to a stage.
  [[nodiscard]] bool is_varied(const MotionSpec& motion) const {
    if (!scenario_.study) return false;
    Value name;
    name.type = Value::Type::string;
    name.text = motion.name;
    const std::string text = to_toml(name);
    const auto gives = [&](const VarySpec& axis, std::size_t key) {
      const auto path = parse_key_path(axis.keys[key]);
      return path && path->front().key == "stage" && path->back().key == "motion" &&
             std::ranges::any_of(axis.values, [&](const auto& row) { return row.at(key) == text; });
    };
    return std::ranges::any_of(scenario_.study->vary, [&](const VarySpec& axis) {
      for (std::size_t key = 0; key < axis.keys.size(); ++key)
        if (gives(axis, key)) return true;
      return false;
    });
  }

  // Of a stage that shakes, after another one.
  void check_late_falls(const std::string& path, const Stage& before) {
    if (!has_opening() || scenario_.accepted.late_falls) return;
    if (before.kind == StageKind::settle)
      warn(
          "{}: what hangs loose comes down during the shaking, and counts as the earthquake's; a stage of "
          "kind \"rest\" with until = \"still\" before it tells the two apart",
          path);
    if (before.kind == StageKind::rest && !before.until_still)
      warn(
          "{}: what hangs loose and is not down after {} s of '{}' counts as the earthquake's; "
          "until = \"still\" there waits for it",
          path, before.duration.value_or(0.0), before.name);
  }

  // What is not released still holds the wall, as if rock were there that is not.
  void check_release() {
    std::map<int, double> released;
    bool is_told = false;
    const auto check = [&](const std::string& path, const char* when) {
      for (const auto& [e, share] : released) {
        if (share == 1.0 || is_told) continue;
        warn("{}: {}, {} of the forces of the rock of '{}' are not released and still hold its wall", path,
             when, 1.0 - share, scenario_.excavations[static_cast<std::size_t>(e)].name);
        is_told = true;
      }
    };
    for (const Stage& stage : scenario_.stages) {
      for (const auto& [e, share] : stage.release) released[e] = share;
      if (stage.kind != StageKind::settle) check(join_path("stage", stage.name), "in a dynamic stage");
    }
    if (!scenario_.stages.empty())
      check(join_path("stage", scenario_.stages.back().name), "at the end of the run");
  }

  /// Of the file: those that [safety] leaves out, too.
  template <class Is>
  [[nodiscard]] bool any_stage(const Is& is) const {
    return std::ranges::any_of(scenario_.stages, is) || std::ranges::any_of(scenario_.left_out, is);
  }

  [[nodiscard]] bool has_opening() const {
    return std::any_of(scenario_.stages.begin(), scenario_.stages.end(),
                       [](const Stage& stage) { return !stage.excavate.empty(); });
  }

  const Scenario& scenario_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> rock_mass_warnings(const Scenario& scenario) {
  return Plausibility(scenario).rock_mass_warnings();
}

void add_block_warnings(const Scenario& scenario, const BlockModel& model,
                        std::vector<std::string>& warnings) {
  const std::vector<cutting::CutBlock>& blocks = model.system.blocks;
  if (!scenario.accepted.skipped) warnings.insert(warnings.end(), model.skipped.begin(), model.skipped.end());
  for (std::size_t k = 0; k < scenario.excavations.size(); ++k) {
    const auto held = std::count_if(blocks.begin(), blocks.end(), [&](const cutting::CutBlock& block) {
      return std::find(block.excavations.begin(), block.excavations.end(), static_cast<int>(k)) !=
             block.excavations.end();
    });
    const std::string& path = scenario.excavations[k].path;
    if (held == 0) warnings.push_back(path + ": holds no block");
    if (held > 0 && static_cast<std::size_t>(held) == blocks.size())
      warnings.push_back(path + ": holds every block; no rock is left");
  }
  add_own_joint_warnings(scenario, model, warnings);
  if (!scenario.domain) return;
  add_joint_warnings(scenario, model, warnings);
  for (std::size_t k = 0; k < scenario.trace_maps.size(); ++k) {
    const rockmass::TraceSource source{rockmass::TraceSource::Kind::trace_map, static_cast<int>(k)};
    Box map;
    double inside = 0.0;
    for (const rockmass::Trace& trace : model.traces) {
      if (!(trace.source == source)) continue;
      map.add(trace.a);
      map.add(trace.b);
      inside += rockmass::length_inside(trace, scenario.domain->box());
    }
    if (inside > 0.0) continue;
    warnings.push_back(fmt::format(
        "{}: no trace meets the domain; the map reaches from [{:.6g}, {:.6g}] to [{:.6g}, {:.6g}]",
        scenario.trace_maps[k].path, map.min.x, map.min.y, map.max.x, map.max.y));
  }
}

namespace {

/// Thresholds that no run reaches.
void warn_of_levels(const Scenario& scenario, std::vector<std::string>& warnings) {
  double openings = 0.0;  // m²
  for (const ExcavationSpec& spec : scenario.excavations)
    openings += std::abs(signed_area(excavation_outline(spec)));
  for (const LevelSpec& level : scenario.study->levels) {
    if (level.measure.ends_with("_ratio") && level.threshold > 1.0)
      warnings.push_back(fmt::format(
          "study.level '{}': {} is a share, and never above {:.4g}; was it in per cent? That is {:.4g}",
          level.name, level.measure, level.threshold, level.threshold / 100.0));
    if (level.measure == "fallen_area_m2" && openings > 0.0 && level.threshold > openings)
      warnings.push_back(
          fmt::format("study.level '{}': {:.4g} m2 fallen are more than all openings hold, {:.4g} m2",
                      level.name, level.threshold, openings));
  }
}

}  // namespace

std::vector<std::string> study_warnings(const Scenario& scenario) {
  std::vector<std::string> warnings;
  if (!scenario.study) return warnings;
  const StudySpec& study = *scenario.study;
  const bool is_random = !scenario.joint_sets.empty() || has_random_strengths(scenario);
  if (!is_random && study.until)
    warnings.emplace_back(
        "study.until: nothing is random, neither joint sets nor strengths; all realizations are the same");
  else if (!is_random && study.realizations != 1)
    warnings.push_back(fmt::format(
        "study.realizations = {}: nothing is random, neither joint sets nor strengths; all are the same",
        study.realizations));
  if (study.latin_hypercube && !has_strengths_of_realizations(scenario))
    warnings.emplace_back(
        "study.sampling = \"latin_hypercube\": no strength is drawn once in each realization (per = "
        "\"realization\"), so that "
        "it changes nothing");
  warn_of_levels(scenario, warnings);
  if (!study.vary.empty()) {
    std::vector<std::string> of_records;  // given where the scenario is read
    add_study_scale_warnings(scenario, read_motions(scenario, of_records), warnings);
  }
  return warnings;
}

std::vector<std::string> plausibility_warnings(const Scenario& scenario) {
  return Plausibility(scenario).warnings();
}

}  // namespace keyblock::scenario
