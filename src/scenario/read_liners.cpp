// Keys of [[liner]].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr double default_shear = 0.4;  // of the normal stiffness
constexpr double most_stations = 5000.0;

class LinerReader {
 public:
  LinerReader(TableReader& t, LinerSpec& spec, Scenario& scenario)
      : t_(t), spec_(spec), liner_(spec.liner), scenario_(scenario) {}

  void read() {
    t_.name("name", liner_.name, "liner",
            {.meaning = "Name in results, of histories, and by which a stage installs it. Its stations are "
                        "NAME.1, NAME.2 and so on, counter-clockwise about the opening.",
             .required = true});
    read_present(t_, liner_.name, scenario_);
    read_wall();
    read_section();
    read_interface();
    read_strength();
  }

 private:
  [[nodiscard]] bool any() const { return t_.documenting(); }

  void read_wall() {
    const bool is_outline = t_.find("excavation") != nullptr;
    std::string excavation;
    if (t_.reference(
            "excavation", excavation, "excavation",
            {.meaning = "The opening along whose outline it lies. Put it into `install` of the stage "
                        "that excavates it, or of a later one.",
             .fallback = "required, or points"})) {
      const auto& names = t_.context().list_names["excavation"];
      spec_.excavation = static_cast<int>(std::ranges::find(names, excavation) - names.begin());
    }
    Rule arc{.meaning =
                 "Part of the outline that it covers: angles about its centroid, counter-clockwise from +x.",
             .unit = "°",
             .fallback = "all of the outline: a closed ring"};
    arc.applies = is_outline || any();
    arc.condition = "excavation";
    const bool has_arc = t_.interval("arc", spec_.arc, arc);
    if (has_arc && (spec_.arc->second - spec_.arc->first >= 360.0 || std::abs(spec_.arc->first) > 720.0))
      t_.fail("arc", fmt::format("[{}, {}]", spec_.arc->first, spec_.arc->second),
              "angles within one turn, such as [-30, 210]; none for a closed ring");
    Rule points{.meaning = "In the place of excavation: vertices of the wall, with rock on one side.",
                .unit = "m",
                .required = !is_outline && !any(),
                .fallback = "excavation"};
    points.applies = !is_outline || any();
    points.condition = "no excavation";
    t_.points("points", liner_.wall, points);
    if (is_outline || any() || t_.find("points") == nullptr) return;
    bool repeats = liner_.wall.size() < 2;
    for (std::size_t k = 1; k < liner_.wall.size(); ++k) repeats |= liner_.wall[k] == liner_.wall[k - 1];
    if (repeats)
      t_.fail("points", "points that repeat, or fewer than two", "two or more points, each another one");
  }

  void read_section() {
    t_.number("thickness", liner_.thickness,
              {.meaning = "Of the liner.",
               .unit = "m",
               .required = true,
               .above = 0.0,
               .usual = &usual::liner_thickness});
    t_.number("young", liner_.young,
              {.meaning = "Young's modulus of the liner.",
               .unit = "Pa",
               .required = true,
               .above = 0.0,
               .usual = &usual::liner_young});
    t_.number("poisson", liner_.poisson,
              {.meaning = "Poisson's ratio. In plane strain the liner is stiffer by 1/(1 − ν²).",
               .at_least = 0.0,
               .at_most = 0.49,
               .usual = &usual::poisson});
    t_.number(
        "density", liner_.density,
        {.meaning = "Of the liner; it has weight.", .unit = "kg/m³", .above = 0.0, .usual = &usual::density});
    t_.number("element_length", liner_.element_length,
              {.meaning = "Distance of its stations, at the most.",
               .unit = "m",
               .above = 0.0,
               .fallback = "a third of (4 E I/normal_stiffness)^¼, a quarter of the thickness at the least, "
                           "0.25 m at the most",
               .usual = &usual::spacing});
    double length = 0.0;
    for (std::size_t k = 1; k < liner_.wall.size(); ++k) length += norm(liner_.wall[k] - liner_.wall[k - 1]);
    if (liner_.element_length && length > most_stations * *liner_.element_length)
      t_.fail("element_length", fmt::format("{} m, for a wall of {:.6g} m", *liner_.element_length, length),
              fmt::format("{:.6g} m at the least", length / most_stations));
  }

  void read_interface() {
    t_.number("normal_stiffness", liner_.normal_stiffness,
              {.meaning = "Of the interface to the rock, across it.",
               .unit = "Pa/m",
               .required = true,
               .above = 0.0,
               .usual = &usual::stiffness});
    liner_.shear_stiffness = default_shear * liner_.normal_stiffness;
    t_.number("shear_stiffness", liner_.shear_stiffness,
              {.meaning = "Along it; 0: the liner slips freely.",
               .unit = "Pa/m",
               .at_least = 0.0,
               .fallback = "0.4 of normal_stiffness"});
    t_.number("adhesion", liner_.adhesion,
              {.meaning = "Tensile strength of the bond to the rock. Beyond it the bond breaks, and the "
                          "liner is pressed on alone.",
               .unit = "Pa",
               .at_least = 0.0,
               .usual = &usual::strength});
    t_.number(
        "cohesion", liner_.cohesion,
        {.meaning =
             "Shear strength of the bond without normal stress. Beyond it, and friction, the bond breaks.",
         .unit = "Pa",
         .at_least = 0.0,
         .usual = &usual::strength});
    double friction = 0.0;
    t_.number("friction", friction,
              {.meaning = "Friction angle of the interface, bonded or broken.",
               .unit = "°",
               .at_least = 0.0,
               .below = 90.0,
               .usual = &usual::friction});
    liner_.friction = std::tan(friction * std::numbers::pi / 180.0);
  }

  void read_strength() {
    t_.number("compressive_strength", liner_.compressive_strength,
              {.meaning = "Of the liner, for its utilization and the capacity diagram. It does not yield.",
               .unit = "Pa",
               .above = 0.0,
               .fallback = "no utilization",
               .usual = &usual::compressive_strength});
    t_.number("tensile_strength", liner_.tensile_strength,
              {.meaning = "Likewise, in tension.",
               .unit = "Pa",
               .above = 0.0,
               .fallback = "no utilization",
               .usual = &usual::strength});
    if (!any() && liner_.compressive_strength.has_value() != liner_.tensile_strength.has_value())
      t_.fail(liner_.compressive_strength ? "tensile_strength" : "compressive_strength", "nothing",
              "a strength in compression and in tension, or neither");
    Rule factor{.meaning = "That strengths are divided by.", .at_least = 1.0, .at_most = 10.0};
    factor.applies = liner_.compressive_strength.has_value() || any();
    factor.condition = "compressive_strength";
    t_.number("safety_factor", liner_.safety_factor, factor);
  }

  TableReader& t_;
  LinerSpec& spec_;
  loading::Liner& liner_;
  Scenario& scenario_;
};

}  // namespace

void read_liners(TableReader& root, Scenario& scenario) {
  root.tables(
      "liner", scenario.liners,
      {.meaning = "Shotcrete on the wall of an opening: an elastic beam on an interface to the rock. It "
                  "has no force when it is installed."},
      [&](TableReader& t, LinerSpec& spec) { LinerReader(t, spec, scenario).read(); });
  std::vector<std::string>& names = root.context().list_names[std::string(names_of_supports)];
  for (const LinerSpec& spec : scenario.liners) names.push_back(spec.liner.name);
}

}  // namespace keyblock::scenario
