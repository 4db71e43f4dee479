#include "scenario/ground_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rockmass/section.h"
#include "scenario/bolts.h"
#include "scenario/load_checks.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using rockmass::StrengthKey;

/// Values of a fact that are named; of more, the first and the last.
constexpr std::size_t most_values = 4;
/// Loads that are listed one by one.
constexpr std::size_t most_loads = 6;
constexpr double least_angle = 1e-6;  // ° that gravity is turned by

std::string number(double x) {
  return fmt::format("{:.4g}", x);
}

/// 20e9 and "/m" as "20 GPa/m".
std::string pressure(double pa, const char* per = "") {
  constexpr std::pair<double, const char*> units[] = {{1e9, "GPa"}, {1e6, "MPa"}, {1e3, "kPa"}};
  for (const auto& [size, name] : units)
    if (std::abs(pa) >= size) return fmt::format("{} {}{}", number(pa / size), name, per);
  return pa == 0.0 ? "0" : fmt::format("{} Pa{}", number(pa), per);
}

std::string force(double n) {
  return std::abs(n) >= 1e6   ? number(n / 1e6) + " MN/m"
         : std::abs(n) >= 1e3 ? number(n / 1e3) + " kN/m"
                              : number(n) + " N/m";
}

/// The nearest of eight.
const char* arrow(Vec2 v) {
  constexpr std::array<const char*, 8> arrows{"→", "↗", "↑", "↖", "←", "↙", "↓", "↘"};
  if (norm(v) == 0.0) return "";
  const auto eighth = std::lround(std::atan2(v.y, v.x) / (0.25 * std::numbers::pi));
  return arrows[static_cast<std::size_t>((eighth + 8) % 8)];
}

std::string length(const rockmass::Distribution& d) {
  const std::string spread = d.std > 0.0 ? " ± " + number(d.std) : "";
  return number(d.mean) + spread + " m";
}

std::string quoted(const char* what, const std::string& name) {
  return fmt::format("{} “{}”", what, name);
}

std::string joined(const std::vector<std::string>& parts, const char* between = ", ") {
  return fmt::format("{}", fmt::join(parts, between));
}

class Facts {
 public:
  explicit Facts(const Scenario& scenario) : scenario_(scenario) {}

  std::vector<GroundFact> all() {
    for (const ExcavationSpec& spec : scenario_.excavations) opening(spec);
    gravity();
    stress();
    rock();
    joints();
    for (const JointSetSpec& spec : scenario_.joint_sets) set(spec);
    if (scenario_.rock_bridge) add("rock bridges", own(scenario_.rock_bridge->joints, "as all joints"));
    for (const InterfaceSpec& spec : scenario_.interfaces)
      add(quoted("interface", spec.name), own(spec.joints, "as all joints"));
    for (const TraceMapSpec& spec : scenario_.trace_maps)
      add(quoted("trace map", spec.name), own(spec.joints, "as all joints"));
    for (const RegionSpec& spec : scenario_.regions) add(quoted("region", spec.name), own_rock(spec.rock));
    around();
    shaking();
    for (const record::Stage& stage : scenario_.stages) {
      if (stage.k_h != 0.0 || stage.k_v != 0.0)
        add(quoted("seismic coefficients in", stage.name),
            fmt::format("k_h {}, k_v {}", number(stage.k_h), number(stage.k_v)));
      if (stage.strength_factor != 1.0)
        add(quoted("strength of joints in", stage.name),
            fmt::format("divided by {}{}", number(stage.strength_factor),
                        stage.strength_of.empty() ? "" : ": " + joined(stage.strength_of)));
    }
    for (const WaterSpec& spec : scenario_.waters) water(spec);
    loads();
    if (!scenario_.supports.empty()) add("supports", std::to_string(scenario_.supports.size()));
    if (!scenario_.springs.empty()) add("springs", springs());
    for (const BoltSpec& spec : scenario_.bolts) bolts(spec);
    for (const LinerSpec& spec : scenario_.liners) liner(spec);
    return std::move(facts_);
  }

 private:
  void add(std::string name, std::string value) { facts_.push_back({std::move(name), std::move(value)}); }

  void opening(const ExcavationSpec& spec) {
    const Box box = bounds(Polygon{excavation_outline(spec), {}});
    const char* shape = spec.shape == ExcavationShape::circle      ? "circle"
                        : spec.shape == ExcavationShape::horseshoe ? "horseshoe"
                        : spec.shape == ExcavationShape::file      ? "outline of a drawing"
                        : spec.shape == ExcavationShape::slope     ? "slope"
                                                                   : "polygon";
    add(quoted("opening", spec.name),
        fmt::format("{}, {} m wide, {} m high", shape, number(box.size().x), number(box.size().y)));
  }

  void gravity() {
    const Vec2 g = scenario_.gravity;
    if (norm(g) == 0.0) return add("gravity", "none");
    const double angle = std::atan2(g.x, -g.y) * 180.0 / std::numbers::pi;
    std::string text = fmt::format("{} m/s² {}", number(norm(g)), arrow(g));
    if (std::abs(angle) > least_angle)
      text += fmt::format(", {}° from downwards, to the {}", number(std::abs(angle)),
                          angle < 0.0 ? "left" : "right");
    add("gravity", std::move(text));
  }

  void loads() {
    const std::vector<loading::Load>& loads = scenario_.loads;
    for (std::size_t k = 0; k < std::min(loads.size(), most_loads); ++k) {
      const loading::Load& load = loads[k];
      const Vec2 sum = resultant(scenario_, load);
      std::string text = fmt::format("{} {}", force(norm(sum)), arrow(sum));
      if (load.is_line) text += fmt::format(" along {} m", number(norm(load.to - load.from)));
      if (!load.factor.empty()) text += ", at its largest over time";
      add(fmt::format("load {} on “{}”", k + 1, load.block), std::move(text));
    }
    if (loads.size() > most_loads) add("more loads", std::to_string(loads.size() - most_loads));
  }

  [[nodiscard]] std::string springs() const {
    const auto absent = std::ranges::count_if(scenario_.springs, [&](const loading::Spring& spring) {
      return std::ranges::find(scenario_.absent, spring.name) != scenario_.absent.end();
    });
    const std::string count = std::to_string(scenario_.springs.size());
    return absent == 0 ? count : fmt::format("{}, {} of them not present", count, absent);
  }

  void bolts(const BoltSpec& spec) {
    const loading::Bolt& bolt = spec.bolt;
    std::string text;
    if (spec.excavation >= 0) {
      const ExcavationSpec& opening = scenario_.excavations[static_cast<std::size_t>(spec.excavation)];
      text = fmt::format("{} of {} m along “{}”", pattern_of(spec, excavation_outline(opening)).size(),
                         number(spec.length), opening.name);
    } else {
      text = fmt::format("one of {} m from ({}, {})", number(bolt.length()), number(bolt.head.x),
                         number(bolt.head.y));
    }
    text += fmt::format(", {}, every {} m", bolt.is_anchored ? "anchored" : "grouted", number(bolt.spacing));
    text += bolt.yield ? fmt::format(", yield {} kN", number(*bolt.yield / 1e3)) : ", no yield";
    if (bolt.pretension > 0.0) text += fmt::format(", pretension {} kN", number(bolt.pretension / 1e3));
    add(quoted("bolts", bolt.list), text + when_there(bolt.list));
  }

  void liner(const LinerSpec& spec) {
    const loading::Liner& liner = spec.liner;
    std::string text = fmt::format("{} m thick", number(liner.thickness));
    if (spec.excavation >= 0)
      text +=
          fmt::format(" along “{}”", scenario_.excavations[static_cast<std::size_t>(spec.excavation)].name);
    text += fmt::format(", adhesion {}, cohesion {}", pressure(liner.adhesion), pressure(liner.cohesion));
    if (!liner.compressive_strength) text += ", no strength";
    add(quoted("liner", liner.name), text + when_there(liner.name));
  }

  [[nodiscard]] std::string when_there(const std::string& name) const {
    std::string text;
    for (const record::Stage& stage : scenario_.stages)
      if (std::ranges::find(stage.install, name) != stage.install.end())
        text += fmt::format(", from “{}” on", stage.name);
    if (std::ranges::find(scenario_.absent, name) != scenario_.absent.end()) text += ", not present";
    return text;
  }

  void water(const WaterSpec& spec) {
    const auto [low, high] = std::ranges::minmax(spec.table, {}, &Vec2::y);
    std::string text = low.y == high.y ? fmt::format("level at {} m", number(low.y))
                                       : fmt::format("table from {} to {} m", number(low.y), number(high.y));
    const double weight = -spec.density * scenario_.gravity.y;
    text += fmt::format(", γw {} kN/m³", number(weight / 1e3));
    if (spec.sets)
      text +=
          fmt::format(", in {} of {} sets and maps", std::ranges::count(*spec.sets, true), spec.sets->size());
    for (const record::Stage& stage : scenario_.stages)
      if (stage.water && *stage.water >= 0 &&
          scenario_.waters[static_cast<std::size_t>(*stage.water)].name == spec.name)
        text += fmt::format(", from “{}” on", stage.name);
    add(spec.name.empty() ? "water" : quoted("water", spec.name), std::move(text));
  }

  void stress() {
    if (!scenario_.in_situ) return add("stress before excavation", "of its own weight");
    const InSituSpec& spec = *scenario_.in_situ;
    if (!spec.depth)
      return add("stress before excavation",
                 fmt::format("σxx {}, σyy {}, σxy {} (compression negative)", pressure(spec.sxx),
                             pressure(spec.syy), pressure(spec.sxy)));
    add("depth", number(*spec.depth) + " m of rock above the model");
    add("K₀", number(*spec.k0));
  }

  void rock() {
    const RockKeys& rock = scenario_.rock;
    const double weight = *rock.density * norm(scenario_.gravity);
    add("unit weight γ", weight > 0.0
                             ? fmt::format("{} kN/m³ ({} kg/m³)", number(weight / 1e3), number(*rock.density))
                             : number(*rock.density) + " kg/m³, no gravity");
    add("Young's modulus E", pressure(*rock.young));
    add("Poisson's ratio ν", number(*rock.poisson));
    const std::string order = *rock.order == automatic_order ? "automatic" : std::to_string(*rock.order);
    add("section", fmt::format("plane {}, blocks of order {}",
                               *rock.state == block::PlaneState::plane_strain ? "strain" : "stress", order));
  }

  void joints() {
    const JointKeys& joints = scenario_.joints;
    add("joints: friction φ", number(joints.friction.value_or(0.0)) + "°");
    add("joints: cohesion c", pressure(joints.cohesion.value_or(0.0)));
    if (joints.tension.value_or(0.0) > 0.0) add("joints: tensile strength", pressure(*joints.tension));
    if (joints.has_residual()) add("joints: residual strength", residual(joints));
    if (joints.strength_factor) add("joints: strength divided by", number(*joints.strength_factor));
    const double normal = joints.normal_stiffness.value_or(scenario_.solver.penalty * *scenario_.rock.young);
    const double shear = joints.shear_stiffness.value_or(contact::JointProperties{}.stiffness_ratio * normal);
    const char* standard = joints.normal_stiffness ? "" : " (default)";
    add("joints: stiffness",
        fmt::format("kn {}, ks {}{}", pressure(normal, "/m"), pressure(shear, "/m"), standard));
  }

  /// Of a strength that is drawn: " ± 3°".
  static std::string spread(const JointKeys& joints, StrengthKey key) {
    const auto& random = joints.random[static_cast<std::size_t>(key)];
    if (!random || random->distribution.std == 0.0) return random ? " (drawn)" : "";
    const double std = random->distribution.std;
    return " ± " + (rockmass::is_friction(key) ? number(std) + "°" : pressure(std));
  }

  /// What is left of strength, and after which slip.
  static std::string residual(const JointKeys& joints) {
    std::vector<std::string> parts;
    if (joints.residual_friction)
      parts.push_back("φr " + number(*joints.residual_friction) + "°" +
                      spread(joints, StrengthKey::residual_friction));
    if (joints.residual_cohesion)
      parts.push_back("cr " + pressure(*joints.residual_cohesion) +
                      spread(joints, StrengthKey::residual_cohesion));
    if (joints.weakening_slip)
      parts.push_back(*joints.weakening_slip > 0.0
                          ? "after a slip of " + number(*joints.weakening_slip) + " m"
                          : "at the first slip");
    return joined(parts);
  }

  /// What a set or map gives of its own.
  static std::string own(const JointKeys& joints, const char* nothing) {
    std::vector<std::string> parts;
    if (joints.friction)
      parts.push_back("φ " + number(*joints.friction) + "°" + spread(joints, StrengthKey::friction));
    if (joints.cohesion)
      parts.push_back("c " + pressure(*joints.cohesion) + spread(joints, StrengthKey::cohesion));
    if (joints.tension)
      parts.push_back("tensile strength " + pressure(*joints.tension) + spread(joints, StrengthKey::tension));
    if (joints.has_residual()) parts.push_back(residual(joints));
    if (joints.strength_factor) parts.push_back("strength divided by " + number(*joints.strength_factor));
    if (joints.normal_stiffness) parts.push_back("kn " + pressure(*joints.normal_stiffness, "/m"));
    if (joints.shear_stiffness) parts.push_back("ks " + pressure(*joints.shear_stiffness, "/m"));
    return parts.empty() ? nothing : joined(parts);
  }

  static std::string own_rock(const RockKeys& rock) {
    std::vector<std::string> parts;
    if (rock.density) parts.push_back(number(*rock.density) + " kg/m³");
    if (rock.young) parts.push_back("E " + pressure(*rock.young));
    if (rock.poisson) parts.push_back("ν " + number(*rock.poisson));
    return parts.empty() ? "as the rock" : joined(parts);
  }

  void set(const JointSetSpec& spec) {
    const rockmass::JointSet& set = spec.set;
    std::vector<std::string> parts{
        fmt::format("dip {}° towards {}°", number(set.dip), number(set.dip_direction))};
    if (scenario_.section_azimuth) {
      const double dip = rockmass::apparent_dip(set.dip, set.dip_direction, *scenario_.section_azimuth);
      parts.back() += fmt::format(" ({:.0f}° down to the {} in the section)", std::abs(dip),
                                  dip < 0.0 ? "left" : "right");
    }
    parts.push_back("spacing " + length(set.spacing));
    parts.push_back("length " + length(set.length));
    const std::string properties = own(spec.joints, "");
    if (!properties.empty()) parts.push_back(properties);
    add(quoted("set", set.name), joined(parts));
  }

  /// What is around the model, where waves of an earthquake meet it.
  void around() {
    if (scenario_.boundary && scenario_.boundary->sides != record::Sides::frame) {
      const BoundarySpec& spec = *scenario_.boundary;
      const char* sides = spec.sides == record::Sides::free_field ? "free field"
                          : spec.sides == record::Sides::viscous  ? "viscous"
                                                                  : "rollers";
      add("boundary", fmt::format("{} base, {} at the sides, {}", spec.compliant ? "compliant" : "rigid",
                                  sides, spec.overburden ? "overburden" : "free top"));
    } else if (scenario_.domain && scenario_.domain->frame && is_shaken()) {
      add(around_the_model, "closed box: wave stress left out");
    } else if (scenario_.domain) {
      add(around_the_model, scenario_.domain->frame ? fmt::format("fixed frame, friction {}°",
                                                                  number(scenario_.domain->frame_friction))
                                                    : "free boundary");
    }
  }

  [[nodiscard]] bool is_shaken() const {
    return std::ranges::any_of(scenario_.stages,
                               [](const record::Stage& stage) { return stage.motion >= 0; });
  }

  /// The motions that stages apply, once each.
  void shaking() {
    std::vector<int> seen;
    for (const record::Stage& stage : scenario_.stages) {
      if (stage.motion < 0 || std::find(seen.begin(), seen.end(), stage.motion) != seen.end()) continue;
      seen.push_back(stage.motion);
      const MotionSpec& spec = scenario_.motions[static_cast<std::size_t>(stage.motion)];
      add(quoted("motion", spec.name), motion(spec));
    }
  }

  static std::string motion(const MotionSpec& spec) {
    std::vector<std::string> parts;
    if (spec.pga) parts.push_back(fmt::format("brought to a horizontal peak of {} m/s²", number(*spec.pga)));
    if (spec.pgv) parts.push_back(fmt::format("brought to a horizontal peak of {} m/s", number(*spec.pgv)));
    for (const MotionComponentSpec& component : spec.components)
      parts.push_back(component.file.filename().string());
    if (spec.window)
      parts.push_back(
          fmt::format("{} … {} s of it", number(spec.window->first), number(spec.window->second)));
    const auto sine = [&](const char* axis, const std::optional<loading::Sine>& s) {
      if (s)
        parts.push_back(fmt::format("{}: {} m/s² at {} Hz, {} cycles", axis, number(s->amplitude),
                                    number(s->frequency), number(s->cycles)));
    };
    sine("x", spec.sine_x);
    sine("y", spec.sine_y);
    return parts.empty() ? "a table" : joined(parts);
  }

  const Scenario& scenario_;
  std::vector<GroundFact> facts_;
};

}  // namespace

std::vector<GroundFact> ground_facts(const Scenario& scenario) {
  return Facts(scenario).all();
}

void GroundFacts::add(const std::vector<GroundFact>& facts) {
  for (const GroundFact& fact : facts) {
    auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.name == fact.name; });
    if (row == rows_.end()) row = rows_.insert(row, {fact.name, {}});
    if (std::find(row->values.begin(), row->values.end(), fact.value) == row->values.end())
      row->values.push_back(fact.value);
  }
}

std::vector<GroundFact> GroundFacts::merged() const {
  std::vector<GroundFact> facts;
  for (const Row& row : rows_) {
    const bool few = row.values.size() <= most_values;
    facts.push_back({row.name, few ? joined(row.values, " · ")
                                   : fmt::format("{} … {} ({} values)", row.values.front(), row.values.back(),
                                                 row.values.size())});
  }
  return facts;
}

}  // namespace keyblock::scenario
