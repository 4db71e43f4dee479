#include "scenario/magnitudes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "scenario/key_path.h"

namespace keyblock::scenario {
namespace {

/// A unit in which a value may be given by mistake, and what it is in the right one.
struct OtherUnit {
  std::string_view name;
  double factor;
};

/// What a quantity usually is, in its unit. A mistaken unit is named where it brings the value within `likely`.
struct Usual {
  std::string_view unit;
  double least, most;
  double least_likely, most_likely;
  std::span<const OtherUnit> mistaken{};
};

/// Apart, as files are compiled together.
namespace usual_values {

constexpr double gravity = 9.81;
constexpr OtherUnit densities[] = {{"t/m3 or g/cm3", 1e3},
                                   {"kN/m3, a weight", 1e3 / gravity},
                                   {"N/m3, a weight", 1.0 / gravity},
                                   {"lb/ft3", 16.0185}};
constexpr OtherUnit pressures[] = {{"GPa", 1e9}, {"MPa", 1e6}, {"kPa", 1e3}};
constexpr OtherUnit stiffnesses[] = {{"GPa/m", 1e9}, {"MPa/m", 1e6}, {"kPa/m", 1e3}};
constexpr OtherUnit strengths[] = {{"MPa", 1e6}, {"kPa", 1e3}};
constexpr OtherUnit accelerations[] = {{"g", gravity}, {"cm/s2", 1e-2}};
constexpr OtherUnit percents[] = {{"percent", 1e-2}};
constexpr OtherUnit speeds[] = {{"km/s", 1e3}};
constexpr OtherUnit forces[] = {{"kN/m", 1e3}, {"MN/m", 1e6}};
constexpr OtherUnit spring_stiffnesses[] = {{"kN/m per m", 1e3}, {"MN/m per m", 1e6}};

constexpr Usual density{"kg/m3", 1e3, 4e3, 1.5e3, 3.5e3, densities};
constexpr Usual young{"Pa", 1e7, 1e12, 1e8, 2e11, pressures};
constexpr Usual stiffness{"Pa/m", 1e6, 1e14, 1e8, 1e13, stiffnesses};
/// Joints that never break are given any strength.
constexpr Usual strength{"Pa", 1e2, HUGE_VAL, 1e3, 2e7, strengths};
constexpr Usual stress{"Pa", 1e2, 1e9, 5e4, 2e8, strengths};
constexpr Usual friction{"degrees", 5.0, 75.0, 10.0, 60.0};
constexpr Usual stress_ratio{"", 0.0, 5.0, 0.2, 4.0, percents};
constexpr Usual depth{"m", 0.0, 1e4, 0.0, 5e3};
constexpr Usual weight{"m/s2", 1.0, 30.0, 5.0, 15.0, accelerations};
constexpr Usual speed{"m/s", 50.0, 9e3, 150.0, 8e3, speeds};
constexpr Usual wall_pressure{"Pa", 1e3, 2e7, 5e3, 5e6, strengths};
/// Of springs and of points of supports: what holds a block in its place may be as stiff as anybody likes.
constexpr Usual spring_stiffness{"N/m per m", 1e4, HUGE_VAL, 1e5, 1e11, spring_stiffnesses};
constexpr Usual bed_stiffness{"Pa/m", 1e5, HUGE_VAL, 1e6, 1e13, stiffnesses};
constexpr Usual yield{"N/m", 1e3, 1e8, 5e3, 2e7, forces};

}  // namespace usual_values
namespace of = usual_values;

std::string with_unit(double value, std::string_view unit) {
  return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
}

std::string usual_range(const Usual& usual) {
  if (!std::isfinite(usual.most)) return "at least " + with_unit(usual.least, usual.unit);
  if (usual.least == 0.0) return "at most " + with_unit(usual.most, usual.unit);
  return fmt::format("{:.4g} to {}", usual.least, with_unit(usual.most, usual.unit));
}

class Magnitudes {
 public:
  Magnitudes(const Scenario& scenario, std::vector<std::string>& warnings)
      : scenario_(scenario), warnings_(warnings) {}

  void check() {
    check_size("gravity", of::weight, norm(scenario_.gravity));
    check_rock("rock", scenario_.rock);
    for (std::size_t k = 0; k < scenario_.regions.size(); ++k)
      check_rock(join_index("region", k), scenario_.regions[k].rock);
    for (const BlockSpec& block : scenario_.blocks)
      if (!block.fixed) check_rock(block.path, block.rock);
    check_joints("joints", scenario_.joints);
    for (const JointSetSpec& spec : scenario_.joint_sets) check_joints(spec.path, spec.joints);
    for (const TraceMapSpec& spec : scenario_.trace_maps) check_joints(spec.path, spec.joints);
    if (scenario_.domain) check_friction("domain.frame_friction", scenario_.domain->frame_friction);
    if (scenario_.in_situ) check_in_situ(*scenario_.in_situ);
    if (scenario_.boundary) check_boundary(*scenario_.boundary);
    for (const ExcavationSpec& spec : scenario_.excavations) check_walls(spec);
    check_springs();
  }

 private:
  void check_boundary(const BoundarySpec& boundary) {
    check_rock_of_waves("boundary", boundary.density, boundary.vs, boundary.vp);
    for (const RockLayerSpec& layer : boundary.column)
      check_rock_of_waves(layer.path, layer.density, layer.vs, layer.vp);
  }

  void check_rock_of_waves(const std::string& path, std::optional<double> density, std::optional<double> vs,
                           std::optional<double> vp) {
    check_value(join_path(path, "density"), of::density, density);
    check_value(join_path(path, "vs"), of::speed, vs);
    check_value(join_path(path, "vp"), of::speed, vp);
  }

  void check_walls(const ExcavationSpec& spec) {
    const std::string path = join_path(spec.path, "pressure");
    check_size(path, of::wall_pressure, spec.pressure.constant);
    for (const auto& [stage, pressure] : spec.pressure_by_stage)
      check_size(join_path(path, stage), of::wall_pressure, pressure);
  }

  void check_springs() {
    for (std::size_t k = 0; k < scenario_.springs.size(); ++k) {
      const loading::Spring& spring = scenario_.springs[k];
      const std::string path =
          spring.name.empty() ? join_index("spring", k) : join_path("spring", spring.name);
      check_value(join_path(path, "stiffness"), of::spring_stiffness, spring.stiffness);
      check_value(join_path(path, "yield"), of::yield, spring.yield);
    }
    for (std::size_t k = 0; k < scenario_.supports.size(); ++k) {
      const loading::Support& support = scenario_.supports[k];
      check_value(join_path(join_index("support", k), "stiffness"),
                  support.is_edge ? of::bed_stiffness : of::spring_stiffness, support.stiffness);
    }
  }

  void check_rock(const std::string& path, const RockKeys& rock) {
    check_value(join_path(path, "density"), of::density, rock.density);
    check_value(join_path(path, "young"), of::young, rock.young);
  }

  void check_joints(const std::string& path, const JointKeys& joints) {
    check_friction(join_path(path, "friction"), joints.friction);
    check_size(join_path(path, "cohesion"), of::strength, joints.cohesion);
    check_size(join_path(path, "tension"), of::strength, joints.tension);
    check_value(join_path(path, "normal_stiffness"), of::stiffness, joints.normal_stiffness);
    check_value(join_path(path, "shear_stiffness"), of::stiffness, joints.shear_stiffness);
  }

  void check_in_situ(const InSituSpec& in_situ) {
    check_value("in_situ.depth", of::depth, in_situ.depth);
    check_value("in_situ.k0", of::stress_ratio, in_situ.k0);
    check_size("in_situ.sxx", of::stress, in_situ.sxx);
    check_size("in_situ.syy", of::stress, in_situ.syy);
    check_size("in_situ.sxy", of::stress, in_situ.sxy);
  }

  /// Of either sign; none at all is meant.
  void check_size(const std::string& key, const Usual& usual, std::optional<double> value) {
    if (value.value_or(0.0) != 0.0) check_value(key, usual, value);
  }

  void check_value(const std::string& key, const Usual& usual, std::optional<double> value) {
    if (!value || is_usual(usual, std::abs(*value))) return;
    const auto is_likely = [&](double x) { return x >= usual.least_likely && x <= usual.most_likely; };
    const auto meant = std::ranges::find_if(
        usual.mistaken, [&](const OtherUnit& unit) { return is_likely(std::abs(*value) * unit.factor); });
    std::string hint;
    if (meant != usual.mistaken.end())
      hint =
          fmt::format("was it in {}? That is {}", meant->name, with_unit(*value * meant->factor, usual.unit));
    warn(key, usual, *value, hint);
  }

  /// A frictionless joint is meant.
  void check_friction(const std::string& key, std::optional<double> value) {
    if (!value || *value == 0.0 || is_usual(of::friction, *value)) return;
    const double angle = std::atan(*value) * 180.0 / std::numbers::pi;
    std::string hint;
    if (*value < of::friction.least && angle >= of::friction.least_likely &&
        angle <= of::friction.most_likely)
      hint = fmt::format("was it a coefficient? {:.4g} is the tangent of {:.4g} degrees", *value, angle);
    warn(key, of::friction, *value, hint);
  }

  static bool is_usual(const Usual& usual, double value) {
    return value >= usual.least && value <= usual.most;
  }

  void warn(const std::string& key, const Usual& usual, double value, const std::string& hint) {
    std::string text =
        fmt::format("{} = {}{}: ", key, with_unit(value, usual.unit), place_text(scenario_, key));
    text += "usual is " + usual_range(usual);
    warnings_.push_back(text + (hint.empty() ? "" : "; " + hint));
  }

  const Scenario& scenario_;
  std::vector<std::string>& warnings_;
};

}  // namespace

std::string place_text(const Scenario& scenario, const std::string& key) {
  const auto found = scenario.positions.find(key);
  if (found == scenario.positions.end()) return {};
  return found->second.line > 0 ? fmt::format(" (line {})", found->second.line) : " (--set)";
}

void add_magnitude_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  if (scenario.si_units) Magnitudes(scenario, warnings).check();
}

}  // namespace keyblock::scenario
