// Keys of [[bolt]].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenario/bolts.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr Word<bool> bolt_kinds[] = {{"grouted", false}, {"anchored", true}};
constexpr Word<bool> bolt_models[] = {{"joints", false}, {"nodes", true}};
constexpr double most_nodes = 1000.0;  // of a bolt

/// Reads a [[bolt]]; what keys are together is checked at the end.
class BoltReader {
 public:
  BoltReader(TableReader& t, BoltSpec& spec, Scenario& scenario)
      : t_(t), spec_(spec), bolt_(spec.bolt), scenario_(scenario) {}

  void read() {
    t_.name(
        "name", bolt_.list, "bolt",
        {.meaning =
             "Name in results, of histories, and by which a stage installs it. Bolts of a pattern are "
             "NAME.1, "
             "NAME.2 and so on, counter-clockwise. A bolt that no stage installs is there from the start.",
         .required = true});
    read_present(t_, bolt_.list, scenario_);
    read_place();
    read_bar();
    t_.word("kind", bolt_.is_anchored, bolt_kinds,
            {.meaning = "`grouted`: a spring at each joint that it crosses. `anchored`: held at head and toe "
                        "alone, and slack "
                        "where it gets shorter."});
    read_grout();
    read_ends();
    read_dowel();
    check();
  }

 private:
  [[nodiscard]] bool any() const { return t_.documenting(); }

  void read_place() {
    const bool is_pattern = t_.find("excavation") != nullptr, is_one = !is_pattern;
    const auto of_one = [&](std::string_view meaning) {
      Rule rule{.meaning = meaning, .unit = "m", .required = is_one && !any()};
      rule.fallback = "required, or excavation";
      rule.applies = is_one || any();
      rule.condition = "no excavation";
      return rule;
    };
    t_.point("from", bolt_.head, of_one("Head of a single bolt, at the wall."));
    t_.point("to", bolt_.toe, of_one("Its toe, in the rock."));
    if (is_one && !any() && t_.find("from") != nullptr && t_.find("to") != nullptr && bolt_.length() == 0.0)
      t_.fail("to", "the same point as from", "a point of rock at a distance");
    const auto of_pattern = [&](Rule rule) {
      rule.applies = is_pattern || any();
      rule.condition = "excavation";
      return rule;
    };
    std::string excavation;
    if (t_.reference(
            "excavation", excavation, "excavation",
            {.meaning =
                 "In the place of from and to: a pattern of bolts along the outline of this opening, normal "
                 "to it.",
             .fallback = "none"})) {
      const auto& names = t_.context().list_names["excavation"];
      spec_.excavation = static_cast<int>(std::ranges::find(names, excavation) - names.begin());
    }
    const bool has_arc = t_.interval(
        "arc", spec_.arc,
        of_pattern({.meaning =
                        "Part of the outline with bolts: angles about its centroid, counter-clockwise from "
                        "+x. The first and the last bolt are at its ends.",
                    .unit = "°",
                    .fallback = "all of the outline"}));
    if (has_arc && (spec_.arc->second - spec_.arc->first > 360.0 || std::abs(spec_.arc->first) > 720.0))
      t_.fail("arc", fmt::format("[{}, {}]", spec_.arc->first, spec_.arc->second),
              "angles within one turn, such as [30, 150]");
    t_.integer("count", spec_.count,
               of_pattern({.meaning = "How many bolts, evenly along the outline.",
                           .at_least = 1.0,
                           .at_most = 10000.0,
                           .fallback = "required with excavation, or spacing_along"}));
    t_.number("spacing_along", spec_.spacing_along,
              of_pattern({.meaning = "Distance between them along the outline.",
                          .unit = "m",
                          .above = 0.0,
                          .fallback = "required with excavation, or count",
                          .usual = &usual::spacing}));
    t_.number("length", spec_.length,
              of_pattern({.meaning = "Length of each.",
                          .unit = "m",
                          .required = is_pattern && !any(),
                          .above = 0.0,
                          .fallback = "required with excavation",
                          .usual = &usual::opening}));
    if (is_pattern && (spec_.count.has_value() == spec_.spacing_along.has_value()))
      t_.fail(spec_.count ? "spacing_along" : "count", spec_.count ? "count as well" : "nothing",
              "one of the two: count or spacing_along");
  }

  void read_bar() {
    t_.number("spacing", bolt_.spacing,
              {.meaning = "Distance between bolts out of plane. Keys of [[bolt]] are of one bolt.",
               .unit = "m",
               .above = 0.0,
               .usual = &usual::bolt_spacing});
    const bool by_area = t_.find("area") != nullptr;
    t_.number("diameter", diameter_,
              {.meaning = "Of the bar.",
               .unit = "m",
               .required = !by_area && !any(),
               .above = 0.0,
               .at_most = 1.0,
               .fallback = "required, or area",
               .applies = !by_area || any(),
               .condition = "no area",
               .usual = &usual::bar_diameter});
    t_.number("area", bolt_.area,
              {.meaning = "Of the bar, in the place of the diameter.",
               .unit = "m²",
               .above = 0.0,
               .at_most = 1.0,
               .fallback = "by diameter"});
    if (!by_area) bolt_.area = 0.25 * std::numbers::pi * diameter_ * diameter_;
    t_.number(
        "young", bolt_.young,
        {.meaning = "Young's modulus of the bar.", .unit = "Pa", .above = 0.0, .usual = &usual::bar_young});
    t_.number("yield", bolt_.yield,
              {.meaning = "Largest force of the bar, at which it yields and keeps its elongation.",
               .unit = "N",
               .above = 0.0,
               .fallback = "it never yields",
               .usual = &usual::bolt_force});
    t_.number(
        "rupture_strain", bolt_.rupture_strain,
        {.meaning =
             "Plastic strain at which the bar breaks: of its active length, of the whole length where it is "
             "anchored.",
         .above = 0.0,
         .at_most = 10.0,
         .fallback = "it never breaks",
         .applies = bolt_.yield.has_value() || any(),
         .condition = "yield",
         .usual = &usual::rupture_strain});
  }

  Rule grouted(Rule rule) const {
    rule.applies = !bolt_.is_anchored || any();
    rule.condition = "kind = \"grouted\"";
    return rule;
  }

  void read_grout() {
    t_.number("grout_stiffness", bolt_.grout_stiffness,
              grouted({.meaning = "Shear stiffness of the grout.",
                       .unit = "N/m per m of bolt",
                       .required = !bolt_.is_anchored && !any(),
                       .above = 0.0,
                       .fallback = "required",
                       .usual = &usual::grout_stiffness}));
    t_.number("grout_strength", bolt_.grout_strength,
              grouted({.meaning = "Largest shear force of the grout.",
                       .unit = "N per m of bolt",
                       .above = 0.0,
                       .fallback = "it never slips",
                       .usual = &usual::grout_strength}));
    std::optional<std::pair<double, double>> part;
    t_.interval(
        "grouted", part,
        grouted(
            {.meaning = "The part that is grouted, from the head.", .unit = "m", .fallback = "all of it"}));
    bolt_.grouted = part.value_or(std::pair(0.0, length()));
    if (part && (part->first < 0.0 || part->second > length() * (1.0 + 1e-9)))
      t_.fail("grouted", fmt::format("[{}, {}]", part->first, part->second),
              fmt::format("a part of the bolt, from 0 to {:.6g} m", length()));
    read_model();
    bolt_.active_length = 2.0 * bolt_.diameter();
    t_.number("active_length", bolt_.active_length,
              grouted({.meaning = "Length of bar at a joint that yields, and turns where the joint slips.",
                       .unit = "m",
                       .above = 0.0,
                       .fallback = "2 diameters"}));
    if (!bolt_.is_anchored && length() > 0.0 && bolt_.active_length > length())
      t_.fail(spec_.excavation >= 0 ? "length" : "to", fmt::format("a bolt of {:.6g} m", length()),
              fmt::format("a bolt longer than its active length, {:.6g} m", bolt_.active_length));
  }

  void read_model() {
    t_.word("model", bolt_.has_nodes, bolt_models,
            grouted({.meaning = "`joints`: springs at the joints that it crosses. `nodes`: a chain of bars, "
                                "each node in grout of its "
                                "own, so that the bolt slips along its length."}));
    t_.number("node_spacing", bolt_.node_spacing, [&] {
      Rule rule{.meaning = "Distance of its nodes in one block, at the most.",
                .unit = "m",
                .above = 0.0,
                .fallback = "half of √(EA/grout_stiffness), from a diameter to 0.25 m"};
      rule.applies = bolt_.has_nodes || any();
      rule.condition = "model = \"nodes\"";
      return rule;
    }());
    if (bolt_.node_spacing && length() > most_nodes * *bolt_.node_spacing)
      t_.fail("node_spacing", fmt::format("{} m, for a bolt of {:.6g} m", *bolt_.node_spacing, length()),
              fmt::format("a thousandth of the bolt at the least, {:.6g} m", length() / most_nodes));
  }

  void read_ends() {
    t_.boolean("plate", bolt_.has_plate,
               {.meaning = "Whether a plate holds the head against the rock. Without it grout alone does."});
    t_.number(
        "pretension", bolt_.pretension,
        {.meaning = "Force that the bolt has at the end of the stage that installs it, a `settle` stage.",
         .unit = "N",
         .at_least = 0.0,
         .usual = &usual::bolt_force});
  }

  void read_dowel() {
    t_.number("dowel_stiffness", bolt_.dowel_stiffness,
              grouted({.meaning = "Stiffness across the bolt at a joint that slips; 0: none.",
                       .unit = "N/m",
                       .at_least = 0.0,
                       .usual = &usual::dowel_stiffness}));
    t_.number("dowel_strength", bolt_.dowel_strength,
              {.meaning = "Largest force across the bolt at a joint. It falls as the force N along the bolt "
                          "comes near its "
                          "yield: times √(1 − (N/yield)²).",
               .unit = "N",
               .above = 0.0,
               .fallback = "it never yields",
               .applies = bolt_.dowel_stiffness > 0.0 || any(),
               .condition = "dowel_stiffness",
               .usual = &usual::bolt_force});
  }

  [[nodiscard]] double length() const { return spec_.excavation >= 0 ? spec_.length : bolt_.length(); }

  void check() {
    if (any()) return;
    if (bolt_.is_anchored && !bolt_.has_plate)
      t_.fail("plate", "false, of an anchored bolt", "true: without a plate nothing holds its head");
    if (bolt_.pretension > 0.0 && !bolt_.has_plate)
      t_.fail("pretension", fmt::format("{} N without a plate", bolt_.pretension),
              "plate = true, which holds the head");
    if (bolt_.pretension > 0.0 && bolt_.has_nodes)
      t_.fail("pretension", fmt::format("{} N of a bolt with model = \"nodes\"", bolt_.pretension),
              "none, or model = \"joints\"");
    if (bolt_.yield && bolt_.pretension >= *bolt_.yield)
      t_.fail("pretension", fmt::format("{} N", bolt_.pretension),
              fmt::format("less than yield, {} N", *bolt_.yield));
    if (scenario_.springs.end() != std::ranges::find(scenario_.springs, bolt_.list, &loading::Spring::name) &&
        !bolt_.list.empty())
      t_.fail("name", fmt::format("\"{}\", which a [[spring]] has", bolt_.list), "a name of its own");
  }

  TableReader& t_;
  BoltSpec& spec_;
  loading::Bolt& bolt_;
  Scenario& scenario_;
  double diameter_ = 0.0;
};

}  // namespace

void read_bolts(TableReader& root, Scenario& scenario) {
  root.tables("bolt", scenario.bolts,
              {.meaning = "A rock bolt, or a pattern of bolts along the outline of an opening: springs at "
                          "the joints that it crosses. It has "
                          "no force when it is installed, but its pretension."},
              [&](TableReader& t, BoltSpec& spec) { BoltReader(t, spec, scenario).read(); });
  std::vector<std::string>& names = root.context().list_names[std::string(names_of_supports)];
  for (const loading::Spring& spring : scenario.springs) names.push_back(spring.name);
  for (const BoltSpec& spec : scenario.bolts) names.push_back(spec.bolt.list);
}

}  // namespace keyblock::scenario
