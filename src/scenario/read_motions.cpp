#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/hash.h"
#include "core/random.h"
#include "loading/motion_file.h"
#include "loading/motion_measures.h"
#include "loading/motion_text.h"
#include "loading/projection.h"
#include "loading/significant_window.h"
#include "scenario/inputs.h"
#include "scenario/magnitudes.h"

namespace keyblock::scenario {
namespace {

using loading::ComponentDirection;
using loading::GroundMotion;
using loading::MotionComponent;

// Directions that differ by more than this from what a file says are worth a warning. °
constexpr double azimuth_tolerance = 1.0;
// Of components that are normal to each other. °
constexpr double normal_tolerance = 10.0;
// Of the only horizontal component of a record, that is along the section.
constexpr double least_share_of_component = 0.5;
// What is left of one that is normal to the section: its peak is told.
constexpr double none_of_component = 1e-3;

class MotionReader {
 public:
  MotionReader(const Scenario& scenario, std::vector<std::string>& warnings, int realization = 0)
      : scenario_(scenario), warnings_(warnings), realization_(realization) {}

  std::vector<GroundMotion> read() {
    std::vector<GroundMotion> motions;
    for (const MotionSpec& spec : scenario_.motions) {
      if (spec.place == MotionPlace::inside)
        warnings_.push_back(fmt::format(
            "{}.at = \"inside\": an older word for \"incident\", the wave that goes up alone; a record "
            "from a borehole is \"within\"",
            spec.path));
      try {
        motions.push_back(to_target(spec, spec.components.empty() ? tables(spec) : record(spec)));
      } catch (const InputError& error) {
        for (Diagnostic diagnostic : error.diagnostics())
          mistakes_.push_back(placed(spec, std::move(diagnostic)));
      }
    }
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    return motions;
  }

  /// As horizontal_measures has it.
  std::vector<loading::HorizontalMeasures> measure() {
    std::vector<loading::HorizontalMeasures> measures;
    for (const MotionSpec& spec : scenario_.motions) {
      loading::HorizontalMeasures& found = measures.emplace_back();
      if (spec.components.empty()) continue;
      const Components components = read_components(spec);
      const loading::ProjectionOptions options = options_of(spec, components);
      const auto horizontal = loading::horizontal_motion(components, options);
      if (!horizontal) continue;
      const bool has_target = spec.pga || spec.pgv;
      const double factor =
          has_target ? factor_to_target(spec, loading::project_motion(spec.name, components, options)) : 1.0;
      found = loading::horizontal_measures(*horizontal, factor);
    }
    return measures;
  }

  MeasuredRecord record_of(const MotionSpec& spec) {
    try {
      const Components components = read_components(spec);
      const loading::ProjectionOptions options = options_of(spec, components);
      MeasuredRecord found{loading::horizontal_motion(components, options), 0.0,
                           loading::project_motion(spec.name, components, options)};
      for (const auto& [component, direction] : components) {
        if (direction.vertical) continue;
        found.azimuth = direction.azimuth;
        break;
      }
      return found;
    } catch (const InputError& error) {
      std::vector<Diagnostic> mistakes;
      for (const Diagnostic& diagnostic : error.diagnostics()) mistakes.push_back(placed(spec, diagnostic));
      throw InputError(std::move(mistakes));
    }
  }

 private:
  // Mistakes without a file are about keys of the motion.
  Diagnostic placed(const MotionSpec& spec, Diagnostic diagnostic) const {
    if (!diagnostic.where.file.empty()) return diagnostic;
    diagnostic.key = spec.path + (diagnostic.key.empty() ? "" : "." + diagnostic.key);
    diagnostic.where = scenario_.where(diagnostic.key);
    return diagnostic;
  }

  [[noreturn]] void fail(const std::string& key, std::string found, std::string expected) const {
    throw InputError(Diagnostic{scenario_.where(key), key, std::move(found), std::move(expected), ""});
  }

  GroundMotion tables(const MotionSpec& spec) const {
    return loading::table_motion(spec.name, spec.sine_x ? loading::sine_table(*spec.sine_x) : spec.x,
                                 spec.sine_y ? loading::sine_table(*spec.sine_y) : spec.y);
  }

  using Components = std::vector<std::pair<MotionComponent, ComponentDirection>>;

  Components read_components(const MotionSpec& spec) {
    Components components;
    std::vector<Diagnostic> mistakes;
    has_told_of_components_ = false;
    for (const MotionComponentSpec& component : spec.components) {
      warn_of_repetition(spec, component);
      try {
        MotionComponent read = channel(component);
        check_place(spec, component, read);
        const ComponentDirection along = direction(component, read);
        components.emplace_back(std::move(read), along);
      } catch (const InputError& error) {
        mistakes.insert(mistakes.end(), error.diagnostics().begin(), error.diagnostics().end());
      }
    }
    if (!mistakes.empty()) throw InputError(std::move(mistakes));
    return components;
  }

  [[nodiscard]] loading::ProjectionOptions options_of(const MotionSpec& spec,
                                                      const Components& components) const {
    loading::ProjectionOptions options;
    options.section_azimuth = scenario_.section_azimuth.value_or(0.0) + (spec.turned ? turn_of(spec) : 0.0);
    options.window = spec.window;
    if (spec.significant) {
      std::vector<const MotionComponent*> all;
      for (const auto& [component, direction] : components) all.push_back(&component);
      options.window = loading::significant_window(all);
    }
    options.baseline = spec.baseline;
    return options;
  }

  /// °, of seed, realization and name alone, so that options see the same shaking.
  [[nodiscard]] double turn_of(const MotionSpec& spec) const {
    Hash hash;
    hash.add(spec.name.data(), spec.name.size());
    const auto low = static_cast<std::uint32_t>(hash.value()),
               high = static_cast<std::uint32_t>(hash.value() >> 32);
    return 360.0 *
           RandomStream(scenario_.seed, static_cast<std::uint32_t>(realization_), low, high).uniform(0);
  }

  GroundMotion record(const MotionSpec& spec) {
    const Components components = read_components(spec);
    if (!has_told_of_components_) warn_of_azimuths(spec, components);
    const loading::ProjectionOptions options = options_of(spec, components);
    GroundMotion motion = loading::project_motion(spec.name, components, options);
    if (spec.window || spec.significant) warn_of_jumps(spec, motion);
    return motion;
  }

  /// Horizontal components are normal to each other; one alone shakes along the section, or not much.
  void warn_of_azimuths(const MotionSpec& spec,
                        const std::vector<std::pair<MotionComponent, ComponentDirection>>& components) {
    std::vector<std::size_t> horizontal;
    for (std::size_t k = 0; k < components.size(); ++k)
      if (!components[k].second.vertical) horizontal.push_back(k);
    if (horizontal.empty() || scenario_.accepted.azimuth) return;
    const auto azimuth_of = [&](std::size_t k) { return components[horizontal[k]].second.azimuth; };
    const auto key_of = [&](std::size_t k) { return spec.components[horizontal[k]].path + ".azimuth"; };
    if (horizontal.size() == 2) {
      const double apart = std::abs(std::remainder(azimuth_of(1) - azimuth_of(0), 180.0));
      if (90.0 - apart <= normal_tolerance) return;
      warnings_.push_back(fmt::format(
          "{}: {:.4g}°{} and the {:.4g}° of {} are {:.3g}° apart; the horizontal components of a record are "
          "normal to each other, as {:.4g}° and {:.4g}° are",
          key_of(1), azimuth_of(1), place_text(scenario_, key_of(1)), azimuth_of(0), key_of(0),
          std::abs(std::remainder(azimuth_of(1) - azimuth_of(0), 360.0)), azimuth_of(0),
          std::fmod(azimuth_of(0) + 90.0, 360.0)));
      return;
    }
    if (horizontal.size() > 1 || spec.components[horizontal[0]].along_section) return;
    const double across = std::abs(std::remainder(azimuth_of(0) - *scenario_.section_azimuth, 180.0)),
                 share = std::cos(across * std::numbers::pi / 180.0);
    if (share >= least_share_of_component || share < none_of_component) return;
    warnings_.push_back(
        fmt::format("{}: the only horizontal component{}, at {:.4g}°, is {:.3g}° from the section of "
                    "{:.4g}°; {:.2g} % of "
                    "it shakes the section; x = {{ file = … }} takes all of it",
                    key_of(0), place_text(scenario_, key_of(0)), azimuth_of(0), across,
                    *scenario_.section_azimuth, 100.0 * share));
  }

  /// The peak along the section is that of the target.
  [[nodiscard]] GroundMotion to_target(const MotionSpec& spec, const GroundMotion& motion) const {
    return spec.pga || spec.pgv ? motion.scaled(factor_to_target(spec, motion)) : motion;
  }

  [[nodiscard]] double factor_to_target(const MotionSpec& spec, const GroundMotion& motion) const {
    const loading::ShakingMeasures along = loading::measure_along({1.0, 0.0}, motion, 1.0, motion.duration());
    const double found = spec.pga ? along.peak : along.peak_velocity;
    if (!(found > 0.0))
      fail(spec.path + (spec.pga ? ".pga" : ".pgv"),
           "a target for a motion that does not shake along the section",
           "a motion with a horizontal component in the section");
    return (spec.pga ? *spec.pga : *spec.pgv) / found;
  }

  void warn_of_jumps(const MotionSpec& spec, const GroundMotion& motion) {
    const std::string jumps = loading::jumps_text(loading::end_jumps(motion));
    if (!jumps.empty())
      warnings_.push_back(fmt::format(
          "{}.window: the motion {}; baseline = \"taper\" brings both ends to zero", spec.path, jumps));
  }

  // Components are added up, whether or not they are different ones.
  void warn_of_repetition(const MotionSpec& motion, const MotionComponentSpec& component) {
    for (const MotionComponentSpec* before = motion.components.data(); before != &component; ++before) {
      if (before->file != component.file || before->channel.value_or(1) != component.channel.value_or(1) ||
          before->reading.column != component.reading.column ||
          before->along_section != component.along_section)
        continue;
      warnings_.push_back(
          fmt::format("{}: the same record as {}; both are added up", component.path, before->path));
      has_told_of_components_ = true;
    }
  }

  MotionComponent channel(const MotionComponentSpec& spec) {
    std::vector<MotionComponent> read = loading::read_motion_file(spec.file, spec.reading);
    const std::string key = spec.path + ".channel";
    const int count = static_cast<int>(read.size());
    if (!spec.channel && count > 1) {
      std::string labels;
      for (int k = 0; k < count; ++k) {
        labels += fmt::format("{}{}: {}", k == 0 ? "" : ", ", k + 1, read[static_cast<std::size_t>(k)].label);
      }
      fail(key, fmt::format("a file of {} components ({})", count, labels),
           "channel = the number of one of them");
    }
    const int number = spec.channel.value_or(1);
    if (number > count)
      fail(key, fmt::format("the integer {}", number),
           fmt::format("at most {}, the components of the file", count));
    MotionComponent component = std::move(read[static_cast<std::size_t>(number - 1)]);
    for (const std::string& note : component.notes) warnings_.push_back(component.file + ": " + note);
    return component;
  }

  /// What is known to be recorded in a borehole is no outcrop, and what is at the surface is not within the ground.
  void check_place(const MotionSpec& motion, const MotionComponentSpec& spec,
                   const MotionComponent& component) {
    const std::string label = loading::lower(component.label);
    const bool is_told =
        std::ranges::any_of(std::array{"depth", "downhole", "borehole"},
                            [&](const char* word) { return label.find(word) != std::string::npos; });
    if (!component.at_depth && !is_told) return;
    const bool at_depth = component.at_depth.value_or(true);
    const bool compliant = scenario_.boundary && scenario_.boundary->compliant;
    const MotionPlace place = motion.place.value_or(compliant ? MotionPlace::outcrop : MotionPlace::base);
    const std::string key = motion.path + ".at";
    if (at_depth && place != MotionPlace::within && place != MotionPlace::base)
      fail(key,
           fmt::format("{}, with a component that was recorded at depth (\"{}\" of {})",
                       motion.place ? "a motion of an outcrop, or of the wave that goes up" : "nothing",
                       component.label, spec.file.filename().string()),
           "\"within\", with its depth");
    if (!at_depth && place == MotionPlace::within)
      fail(key,
           fmt::format("\"within\", with a component of the surface (\"{}\" of {})", component.label,
                       spec.file.filename().string()),
           "\"outcrop\", or components recorded at depth");
  }

  ComponentDirection direction(const MotionComponentSpec& spec, const MotionComponent& component) {
    if (spec.along_section) {
      if (component.vertical)
        warnings_.push_back(
            fmt::format("{}: the file calls this component \"{}\"", spec.path, component.label));
      return {false, scenario_.section_azimuth.value_or(0.0)};
    }
    const std::string key = spec.path + ".azimuth";
    ComponentDirection along{spec.vertical, spec.azimuth.value_or(0.0)};
    if (!spec.vertical && !spec.azimuth) {
      along = {component.vertical, component.azimuth.value_or(0.0)};
      if (!component.vertical && !component.azimuth) {
        fail(key, fmt::format("nothing, and no direction in the file (\"{}\")", component.label),
             "degrees from north, or \"up\"");
      }
    } else if (along.vertical != component.vertical && (component.vertical || component.azimuth)) {
      warnings_.push_back(fmt::format("{}: the file calls this component \"{}\"", key, component.label));
      has_told_of_components_ = true;
    } else if (!along.vertical && component.azimuth &&
               std::abs(std::remainder(along.azimuth - *component.azimuth, 360.0)) > azimuth_tolerance) {
      warnings_.push_back(
          fmt::format("{} is {}°; the file says {}°", key, along.azimuth, *component.azimuth));
      has_told_of_components_ = true;
    }
    if (!along.vertical && !scenario_.section_azimuth) {
      fail("section.azimuth", "nothing",
           "the direction of the +x axis, for horizontal components of records");
    }
    return along;
  }

  const Scenario& scenario_;
  std::vector<std::string>& warnings_;
  int realization_;
  std::vector<Diagnostic> mistakes_;
  bool has_told_of_components_ = false;  ///< of the motion at hand: that one is another than it seems
};

}  // namespace

std::vector<loading::HorizontalMeasures> horizontal_measures(const Scenario& scenario) {
  std::vector<std::string> unused;  // told where the motions are read
  return MotionReader(scenario, unused).measure();
}

std::vector<GroundMotion> read_motions(const Scenario& scenario, std::vector<std::string>& warnings,
                                       int realization) {
  return MotionReader(scenario, warnings, realization).read();
}

MeasuredRecord measured_record(const Scenario& scenario, const MotionSpec& spec) {
  std::vector<std::string> unused;
  return MotionReader(scenario, unused).record_of(spec);
}

}  // namespace keyblock::scenario
