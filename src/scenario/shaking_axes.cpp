#include "scenario/shaking_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/error.h"
#include "loading/intensity.h"
#include "loading/motion_measures.h"
#include "scenario/inputs.h"
#include "scenario/key_path.h"
#include "scenario/value.h"

namespace keyblock::scenario {
namespace {

constexpr std::size_t fewest_events = 5;
constexpr double far_beyond = 2.0;  // times a limit

loading::DirectionRule rule_of(const std::string& component) {
  using enum loading::DirectionRule;
  if (component == "rotd100") return rotd100;
  if (component == "geometric-mean") return geometric_mean;
  if (component == "arithmetic-mean") return arithmetic_mean;
  return component == "larger" ? larger : rotd50;
}

std::string toml_string(const std::string& text) {
  Value value;
  value.type = Value::Type::string;
  value.text = text;
  return to_toml(value);
}

/// A record of the suite with its intensity.
struct SuiteMember {
  const MotionSpec* motion;
  const loading::SuiteRecord* listed;
  double intensity = 0.0, duration = 0.0;
};

class ShakingAxis {
 public:
  ShakingAxis(const Scenario& scenario, const ShakingSpec& shaking, std::vector<std::string>* warnings)
      : scenario_(scenario),
        shaking_(shaking),
        suite_(scenario.suites.at(static_cast<std::size_t>(shaking.suite))),
        name_(*loading::intensity_named(shaking.intensity)),
        warnings_(warnings) {}

  VarySpec axis() {
    measure_records();
    VarySpec axis;
    for (const std::string& stage : shaking_.stages) {
      const std::string path = join_path("stage", stage);
      axis.keys.push_back(path + ".motion");
      axis.keys.push_back(path + ".scale");
    }
    axis.per_realization = shaking_.per_realization;
    axis.of_block = shaking_.levels_per_record;
    axis.block = shaking_.levels.empty() ? shaking_.scales.size() : shaking_.levels.size();
    for (const SuiteMember& member : members_)
      for (const double scale : scales_of(member)) axis.values.push_back(row(member, scale));
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    tell_of_factors();
    tell_of_events();
    axis.unshaken = row(*std::ranges::max_element(members_, {}, &SuiteMember::duration), 0.0);
    return axis;
  }

 private:
  void measure_records() {
    for (const MotionSpec& motion : scenario_.motions) {
      if (motion.suite != shaking_.suite) continue;
      SuiteMember member{&motion, &suite_.records.at(members_.size())};
      try {
        const MeasuredRecord record = measured_record(scenario_, motion);
        member.duration = record.section.duration();
        member.intensity = intensity(record, member);
      } catch (const InputError& error) {
        mistakes_.insert(mistakes_.end(), error.diagnostics().begin(), error.diagnostics().end());
      }
      members_.push_back(member);
    }
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
  }

  double intensity(const MeasuredRecord& record, const SuiteMember& member) {
    double found = 0.0;
    if (shaking_.component == "section") {
      const loading::ShakingMeasures m = loading::measure(record.section, 1.0, record.section.duration());
      found = name_.kind == loading::IntensityKind::pga   ? m.peak
              : name_.kind == loading::IntensityKind::pgv ? m.peak_velocity
                                                          : m.arias_intensity;
    } else if (!record.horizontal) {
      fail("component",
           fmt::format("the record '{}', whose horizontal components are not at right angles",
                       member.listed->name),
           "records of two components at right angles, or component = \"section\"");
    } else {
      found = loading::intensity_of(*record.horizontal, name_, rule_of(shaking_.component), record.azimuth);
    }
    if (!(found > 0.0))
      fail("intensity", fmt::format("{} of 0 of the record '{}'", name_.text, member.listed->name),
           "records that shake");
    return found;
  }

  void fail(const char* key, std::string found, std::string expected) {
    const std::string path = join_path(shaking_.path, key);
    mistakes_.push_back({scenario_.where(path), path, std::move(found), std::move(expected), ""});
  }

  std::vector<double> scales_of(const SuiteMember& member) {
    std::vector<double> scales;
    for (const double s : shaking_.scales) scales.push_back(s * member.listed->scale);
    for (const double x : shaking_.levels)
      scales.push_back(name_.power == 1 ? x / member.intensity
                                        : std::pow(x / member.intensity, 1.0 / name_.power));
    const auto [least, most] = shaking_.scale_limits;
    for (std::size_t k = 0; k < scales.size(); ++k) {
      const double s = scales[k];
      if (s < least / far_beyond || s > most * far_beyond) {
        fail(shaking_.levels.empty() ? "scales" : "levels",
             fmt::format(
                 "a factor of {:.3g} on the record '{}'{}", s, member.listed->name,
                 shaking_.levels.empty() ? "" : fmt::format(", to come to {:.4g}", shaking_.levels[k])),
             fmt::format("factors from {:.3g} to {:.3g}, by `scale_limits`; or records that shake as much",
                         least, most));
      } else if (s < least || s > most) {
        far_scaled_.insert(member.listed->name);
      }
    }
    return scales;
  }

  [[nodiscard]] std::vector<std::string> row(const SuiteMember& member, double scale) const {
    std::vector<std::string> texts;
    Value number;
    number.type = Value::Type::number;
    number.number = scale;
    for (std::size_t k = 0; k < shaking_.stages.size(); ++k) {
      texts.push_back(toml_string(member.motion->name));
      texts.push_back(to_toml(number));
    }
    return texts;
  }

  void tell_of_factors() {
    if (far_scaled_.empty() || warnings_ == nullptr) return;
    warnings_->push_back(
        fmt::format("{}: factors below {:.3g} or above {:.3g} on {}; a record scaled so far is no longer "
                    "that of such an earthquake",
                    join_path(shaking_.path, "scale_limits"), shaking_.scale_limits.first,
                    shaking_.scale_limits.second, fmt::join(far_scaled_, ", ")));
  }

  void tell_of_events() {
    std::set<std::string> events;
    for (const SuiteMember& member : members_)
      events.insert(member.listed->event.empty() ? member.listed->name : member.listed->event);
    if (events.size() >= fewest_events || warnings_ == nullptr) return;
    warnings_->push_back(
        fmt::format("{}: the interval over records is that of {} earthquake{}, which makes it wide",
                    join_path(shaking_.path, "suite"), events.size(), events.size() == 1 ? "" : "s"));
  }

  const Scenario& scenario_;
  const ShakingSpec& shaking_;
  const SuiteSpec& suite_;
  loading::IntensityName name_;
  std::vector<std::string>* warnings_;
  std::vector<SuiteMember> members_;
  std::set<std::string> far_scaled_;
  std::vector<Diagnostic> mistakes_;
};

}  // namespace

std::vector<VarySpec> shaking_axes(const Scenario& scenario, std::vector<std::string>* warnings) {
  std::vector<VarySpec> axes;
  if (!scenario.study) return axes;
  for (const ShakingSpec& shaking : scenario.study->shaking)
    axes.push_back(ShakingAxis(scenario, shaking, warnings).axis());
  return axes;
}

}  // namespace keyblock::scenario
