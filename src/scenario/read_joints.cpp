#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "rockmass/distribution.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using rockmass::Distribution;
using rockmass::DistributionKind;
using rockmass::most_lognormal_variation;
using rockmass::SpacingMeasure;
using rockmass::StrengthKey;

constexpr Word<SpacingMeasure> spacing_measures[] = {{"true", SpacingMeasure::true_spacing},
                                                     {"trace", SpacingMeasure::trace_spacing}};
constexpr Word<DistributionKind> distribution_kinds[] = {{"constant", DistributionKind::constant},
                                                         {"uniform", DistributionKind::uniform},
                                                         {"normal", DistributionKind::normal},
                                                         {"lognormal", DistributionKind::lognormal},
                                                         {"exponential", DistributionKind::exponential}};

/// Without "line": traces of a map lie on none.
constexpr Word<rockmass::DrawnPer> per_of_maps[] = {{"joint", rockmass::DrawnPer::joint},
                                                    {"realization", rockmass::DrawnPer::realization}};

void check_variation(TableReader& t, const Distribution& distribution) {
  if (distribution.kind != DistributionKind::lognormal || distribution.mean <= 0.0) return;
  const double variation = distribution.std / distribution.mean;
  if (variation <= most_lognormal_variation) return;
  t.fail("std", fmt::format("{:.3g} times the mean", variation),
         fmt::format("at most {} times the mean for \"lognormal\"", most_lognormal_variation));
}

constexpr KeyKind number_kinds[] = {KeyKind::number};

/// What is said of the mean and the standard deviation of a distribution.
struct ShapeWords {
  std::string_view unit, mean, beyond;
  const Usual *usual = nullptr, *usual_std = nullptr;
};

/// `distribution`, `mean` and `std`.
void read_shape(TableReader& d, Distribution& distribution, bool zero_allowed, const ShapeWords& words) {
  d.word("distribution", distribution.kind, distribution_kinds,
         {.meaning = "Its shape. `uniform` spans mean ± √3 std.", .required = true});
  const bool constant = distribution.kind == DistributionKind::constant;
  // One description for all.
  const bool may_be_zero = d.documenting() || (zero_allowed && constant);
  d.number("mean", distribution.mean,
           {.meaning = words.mean,
            .unit = words.unit,
            .required = true,
            .above = may_be_zero ? -HUGE_VAL : 0.0,
            .at_least = may_be_zero ? 0.0 : -HUGE_VAL,
            .usual = words.usual});
  const bool needs_std = !constant && distribution.kind != DistributionKind::exponential;
  const std::string std_text = fmt::format(
      "Standard deviation. `uniform`, `normal` and `lognormal` need it; the others do not use it. For "
      "`lognormal` it is "
      "at most {} times the mean.{}",
      most_lognormal_variation, words.beyond);
  const bool given = d.number("std", distribution.std,
                              {.meaning = std_text,
                               .unit = words.unit,
                               .required = needs_std && !d.documenting(),
                               .at_least = 0.0,
                               .fallback = "required where used",
                               .usual = words.usual_std});
  if (given) check_variation(d, distribution);
}

void read_distribution(TableReader& t, std::string_view key, Distribution& distribution, bool zero_allowed,
                       std::string_view meaning) {
  const Rule rule{.meaning = meaning,
                  .unit = "m",
                  .required = true,
                  .above = zero_allowed ? -HUGE_VAL : 0.0,
                  .at_least = zero_allowed ? 0.0 : -HUGE_VAL,
                  .group = "Distribution",
                  .group_meaning =
                      "A length that varies from joint to joint: a number (the same for all), or a "
                      "table such as `{ mean = 0.3, std = 0.1, distribution = \"normal\" }`. Mean and "
                      "standard deviation are those before the distribution is cut off at zero.",
                  .kinds = number_kinds,
                  .usual = &usual::spacing};
  const Value* value = t.find(key);
  if (value != nullptr && value->is_number()) {
    t.number(key, distribution.mean, rule);
    return;
  }
  if (!t.documenting() && (value == nullptr || !value->is(Value::Type::table))) {
    constexpr std::string_view type = "number or table { mean, std, distribution }";
    if (t.any(key, type, rule) != nullptr) t.fail(key, describe(*value), "a " + std::string(type) + ", in m");
    return;
  }
  t.table(key, rule, [&](TableReader& d) {
    read_shape(d, distribution, zero_allowed,
               {.unit = "m",
                .mean = "Mean. Zero only where a constant gap is meant.",
                .beyond = " Beyond that, fewer than 2 joints in 100 make half of the total length.",
                .usual = &usual::spacing,
                .usual_std = &usual::spacing});
  });
}

/// Whose keys they are: of a set or map they may be drawn, else they are numbers.
enum class JointsOf { numbers, set, map };

struct JointDefaults {
  JointsOf of = JointsOf::numbers;
  bool friction_required = false;
  std::string_view zero, friction, normal, shear, residual_friction;
};

/// One description for all.
std::string_view unit_of(const TableReader& d, StrengthKey key) {
  return d.documenting() ? "of the key" : rockmass::strength_units[static_cast<std::size_t>(key)];
}

/// Ends of a distribution, and whether enough of it lies between them.
void read_ends(TableReader& d, rockmass::RandomStrength& random, StrengthKey key) {
  constexpr double least_kept = 0.01;
  const bool is_angle = rockmass::is_friction(key);
  if (is_angle) random.max = rockmass::most_friction;
  const double at_most = is_angle && !d.documenting() ? rockmass::most_friction : HUGE_VAL;
  d.number("min", random.min,
           {.meaning = "Where it is cut off below.",
            .unit = unit_of(d, key),
            .at_least = 0.0,
            .at_most = at_most});
  d.number("max", random.max,
           {.meaning = "Where it is cut off above.",
            .unit = unit_of(d, key),
            .at_least = 0.0,
            .at_most = at_most,
            .fallback = "89 of angles, else none"});
  if (d.documenting()) return;
  if (random.min >= random.max)
    return d.fail(d.find("max") != nullptr ? "max" : "min",
                  fmt::format("{} to {}, which is nothing", random.min, random.max), "a max above min");
  const double mean = random.distribution.mean;
  if (mean < random.min || mean > random.max)
    return d.fail("mean", fmt::format("{}, outside of {} to {}", mean, random.min, random.max),
                  "a mean from min to max");
  if (random.kept() < least_kept)
    d.fail("min",
           fmt::format("{:.2g} of the distribution from {} to {}", random.kept(), random.min, random.max),
           fmt::format("{} or more of it", least_kept));
}

/// A strength: a number, or of a set or map a distribution.
void read_strength(TableReader& t, JointKeys& joints, StrengthKey key, JointsOf of, const Rule& number) {
  const auto k = static_cast<std::size_t>(key);
  const std::string_view name = rockmass::strength_names[k];
  const Value* value = t.find(name);
  const bool is_table = value != nullptr && value->is(Value::Type::table);
  if (of == JointsOf::numbers || (!t.documenting() && !is_table)) {
    t.number(name, joints.*strength_members[k], number);
    return;
  }
  Rule rule = number;
  rule.group = "Random strength";
  rule.group_meaning =
      "A strength of joints: a number, or a distribution such as `{ mean = 35, std = 3, distribution = "
      "\"normal\", min = 25, max = 45 }`. An angle is below 90°, and drawn up to 89°. Mean and standard "
      "deviation are those before it is cut off at "
      "`min` and `max`. A residual strength above the peak of its joint is that of the peak.";
  rule.kinds = number_kinds;
  t.table(name, rule, [&](TableReader& d) {
    rockmass::RandomStrength random;
    read_shape(d, random.distribution, true,
               {.unit = unit_of(d, key),
                .mean = "Mean. Zero only where it is constant.",
                .beyond = "",
                .usual = number.usual});
    read_ends(d, random, key);
    const Rule per{
        .meaning =
            "What has one value: `joint`, a trace along all of it; `line`, all traces of a set on one line; "
            "`realization`, the whole set or map. Traces of a map lie on no line."};
    of == JointsOf::map && !d.documenting() ? d.word("per", random.per, per_of_maps, per)
                                            : d.word("per", random.per, drawn_per_words, per);
    joints.*strength_members[k] = random.distribution.mean;
    joints.random[k] = random;
  });
}

void read_strength_keys(TableReader& t, JointKeys& joints, const JointDefaults& defaults) {
  const auto strength = [&](StrengthKey key, const Rule& rule) {
    read_strength(t, joints, key, defaults.of, rule);
  };
  strength(StrengthKey::friction, {.meaning = "Friction angle.",
                                   .unit = "°",
                                   .required = defaults.friction_required,
                                   .at_least = 0.0,
                                   .below = 90.0,
                                   .fallback = defaults.friction,
                                   .usual = &usual::friction});
  strength(StrengthKey::cohesion, {.meaning = "Cohesion of a joint in place, lost when it slips or opens.",
                                   .unit = "Pa",
                                   .at_least = 0.0,
                                   .fallback = defaults.zero,
                                   .usual = &usual::strength});
  strength(
      StrengthKey::tension,
      {.meaning =
           "Tensile strength of a joint in place, lost likewise. A joint that is pulled holds less shear, "
           "cohesion − tension · tan(friction): without cohesion the least shear breaks it.",
       .unit = "Pa",
       .at_least = 0.0,
       .fallback = defaults.zero,
       .usual = &usual::strength});
  strength(
      StrengthKey::residual_friction,
      {.meaning = "Friction angle that is left after weakening_slip, and of contacts where no joint was in "
                  "place.",
       .unit = "°",
       .at_least = 0.0,
       .below = 90.0,
       .fallback = defaults.residual_friction,
       .usual = &usual::friction});
  strength(
      StrengthKey::residual_cohesion,
      {.meaning = "Cohesion that is left after weakening_slip, until the joint opens. The same as cohesion: "
                  "slip takes none (ideal plasticity).",
       .unit = "Pa",
       .at_least = 0.0,
       .fallback = defaults.zero,
       .usual = &usual::strength});
  t.number(
      "weakening_slip", joints.weakening_slip,
      {.meaning = "Slip over which friction, cohesion and tension fall to what is left of them. 0: all at "
                  "once when the joint first slips.",
       .unit = "m",
       .at_least = 0.0,
       .fallback = defaults.zero,
       .usual = &usual::weakening});
}

void read_joint_keys(TableReader& t, JointKeys& joints, const JointDefaults& defaults) {
  read_strength_keys(t, joints, defaults);
  t.number("normal_stiffness", joints.normal_stiffness,
           {.meaning = "Normal stiffness of the joint.",
            .unit = "Pa/m",
            .above = 0.0,
            .fallback = defaults.normal,
            .usual = &usual::stiffness});
  t.number("shear_stiffness", joints.shear_stiffness,
           {.meaning = "Shear stiffness of the joint. Given only where a normal stiffness is given, too.",
            .unit = "Pa/m",
            .above = 0.0,
            .fallback = defaults.shear,
            .usual = &usual::stiffness});
}

constexpr JointDefaults joint_defaults{JointsOf::numbers,      true,      "0", "", "20 young per metre",
                                       "0.4 normal_stiffness", "friction"};
/// Of joints that have properties of their own.
constexpr JointDefaults own_defaults(JointsOf of) {
  constexpr std::string_view standard = "of [joints]";
  return {of, false, standard, standard, standard, standard, "of [joints]; else friction"};
}

void read_set_keys(TableReader& t, JointKeys& joints) {
  t.number("strength_factor", joints.strength_factor,
           {.meaning = "Its strength is divided by it, that of all other joints is not.",
            .above = 0.0,
            .fallback = "of [joints]",
            .usual = &usual::strength_factor});
  t.boolean("dry", joints.dry, {.meaning = "Its joints hold no water."});
}

double given(const std::optional<double>& own, const std::optional<double>& standard) {
  return own.value_or(standard.value_or(0.0));
}

/// Strength that is left is no more than strength at the peak, and belongs to something that falls.
void check_residual(TableReader& t, const JointKeys& own, const JointKeys& standard) {
  const double friction = given(own.friction, standard.friction),
               cohesion = given(own.cohesion, standard.cohesion);
  if (own.residual_friction && *own.residual_friction > friction)
    t.fail("residual_friction", fmt::format("{}, above friction = {}", *own.residual_friction, friction),
           "no more than the friction of the peak");
  if (own.residual_cohesion && *own.residual_cohesion > cohesion)
    t.fail("residual_cohesion", fmt::format("{}, above cohesion = {}", *own.residual_cohesion, cohesion),
           "no more than the cohesion of the peak");
}

void check_joint_keys(TableReader& t, const JointKeys& own, const JointKeys& standard) {
  check_residual(t, own, standard);
  if (own.shear_stiffness && !own.normal_stiffness && !standard.normal_stiffness) {
    t.fail("shear_stiffness", "a shear stiffness without a normal stiffness", "normal_stiffness as well");
  }
}

void read_keys_of(TableReader& t, JointKeys& joints, JointsOf of, const JointKeys& standard) {
  read_joint_keys(t, joints, own_defaults(of));
  read_set_keys(t, joints);
  check_joint_keys(t, joints, standard);
}

void read_joint_set(TableReader& t, JointSetSpec& spec, const JointKeys& standard) {
  rockmass::JointSet& set = spec.set;
  spec.path = t.path();
  t.name("name", set.name, "joint_set", {.meaning = "Name in results and key paths.", .required = true});
  t.number("dip", set.dip,
           {.meaning = "Dip of the joint planes below the horizontal.",
            .unit = "°",
            .required = true,
            .at_least = 0.0,
            .at_most = 90.0,
            .usual = &usual::angle});
  t.number("dip_direction", set.dip_direction,
           {.meaning =
                "Direction in which the planes fall, clockwise from north. Toward +x they dip to the right.",
            .unit = "°",
            .required = true,
            .at_least = 0.0,
            .at_most = 360.0,
            .usual = &usual::angle});
  t.number("dip_std", set.dip_std,
           {.meaning = "Scatter of the dip from joint to joint (normal distribution).",
            .unit = "°",
            .at_least = 0.0,
            .at_most = 90.0,
            .usual = &usual::scatter});
  t.number("dip_direction_std", set.dip_direction_std,
           {.meaning = "Scatter of the dip direction, likewise.",
            .unit = "°",
            .at_least = 0.0,
            .at_most = 180.0,
            .usual = &usual::scatter});
  t.word("spacing_measure", set.spacing_measure, spacing_measures,
         {.meaning =
              "How spacing is measured: `true`, normal to the joint planes, or `trace`, between the traces "
              "in the section."});
  read_distribution(t, "spacing", set.spacing, false, "Distance of neighbouring joints.");
  read_distribution(t, "length", set.length, false, "Length of a trace in the section.");
  read_distribution(t, "gap", set.gap, true, "Rock bridge between two traces on one line; 0: none.");
  t.boolean("gap_bonds", spec.gap_bonds,
            {.meaning = "The gaps are joints as well, with the strength of [rock_bridge]."});
  read_keys_of(t, spec.joints, JointsOf::set, standard);
}

void read_trace_map(TableReader& t, TraceMapSpec& map, const JointKeys& standard) {
  map.path = t.path();
  std::vector<std::string_view> given;
  for (const std::string_view key : {"file", "points", "lines", "pattern"}) {
    if (t.find(key) != nullptr) given.push_back(key);
  }
  const bool has_file = t.find("file") != nullptr;
  t.file("file", map.file,
         {.meaning = "Lines as a drawing (ASCII DXF), shapefile, GeoJSON, WKT or table, see [trace "
                     "maps](guide/joints.md#trace-maps), in the "
                     "coordinates of the domain. `file`, `points`, `lines` or `pattern` is required.",
          .required = !t.documenting() && given.empty(),
          .fallback = "points"});
  std::vector<Vec2> points;
  t.points("points", points,
           {.meaning = "The vertices of one trace, in place of a file.", .unit = "m", .fallback = "file"});
  t.lines("lines", map.lines,
          {.meaning = "Several traces, each by its vertices, in place of a file.",
           .unit = "m",
           .fallback = "file"});
  read_tessellation(t, map.tessellation);
  if (given.size() > 1)
    t.fail(given[1], fmt::format("{} and {}", given[1], given[0] == "file" ? "a file" : given[0]),
           "one of the two");
  if (!points.empty() &&
      std::all_of(points.begin(), points.end(), [&](Vec2 p) { return p == points.front(); }))
    t.fail("points", fmt::format("{} points, all the same", points.size()), "two or more different points");
  if (!points.empty()) map.lines = {std::move(points)};
  t.name("name", map.name, "trace_map",
         {.meaning = "Name in results. Required with `points`, `lines` and `pattern`.",
          .required = !t.documenting() && !given.empty() && !has_file,
          .fallback = "that of its only layer, or of the file"});
  read_map_choice(t, map.choice, t.documenting() || has_file, "file");
  if (map.name.empty())
    map.name = map.choice.layers.size() == 1 ? map.choice.layers.front() : map.file.stem().string();
  read_keys_of(t, map.joints, JointsOf::map, standard);
}

}  // namespace

void read_joint_keys_of(TableReader& t, JointKeys& joints, const JointKeys& standard) {
  read_keys_of(t, joints, JointsOf::numbers, standard);  // without traces there is nothing to draw for
}

void read_joints(TableReader& root, Scenario& scenario) {
  const Value* blocks = root.find("block");
  const bool has_contacts = root.find("domain") != nullptr || root.find("block_map") != nullptr ||
                            (blocks != nullptr && blocks->items.size() > 1);
  root.table(
      "joints",
      {.meaning =
           "Properties of all contacts; joint sets, trace maps and interfaces may have their own. Needed "
           "as soon as there are two blocks.",
       .required = has_contacts},
      [&](TableReader& t) {
        read_joint_keys(t, scenario.joints, joint_defaults);
        t.number(
            "strength_factor", scenario.joints.strength_factor,
            {.meaning = "tan(friction), cohesion and tension, residual strength too, are divided by it: the "
                        "value at which rock just falls is a factor of safety. It is that of sets, trace "
                        "maps and interfaces that give none. The frame keeps its friction.",
             .above = 0.0,
             .fallback = "1",
             .usual = &usual::strength_factor});
        check_joint_keys(t, scenario.joints, {});
      });
  root.tables(
      "joint_set", scenario.joint_sets,
      {.meaning = "A family of parallel joints known by its statistics; traces are generated from them."},
      [&](TableReader& t, JointSetSpec& set) { read_joint_set(t, set, scenario.joints); });
  root.tables("trace_map", scenario.trace_maps,
              {.meaning = "Joints mapped one by one, straight or as polylines."},
              [&](TableReader& t, TraceMapSpec& map) { read_trace_map(t, map, scenario.joints); });
  root.table(
      "rock_bridge",
      {.meaning = "Rock that a crack has to break through: joints in gaps (`gap_bonds` of a joint set) and "
                  "before dead ends (`dead_ends` of [cutting]), which is rock until it breaks."},
      [&](TableReader& t) { read_joint_keys_of(t, scenario.rock_bridge.emplace().joints, scenario.joints); });
  std::vector<std::string>& names = root.context().list_names[std::string(names_of_joints)];
  names.emplace_back("joints");
  for (const JointSetSpec& spec : scenario.joint_sets) names.push_back(spec.set.name);
  for (const TraceMapSpec& spec : scenario.trace_maps) names.push_back(spec.name);
  if (scenario.rock_bridge) names.push_back(scenario.rock_bridge->name);
}

}  // namespace keyblock::scenario
