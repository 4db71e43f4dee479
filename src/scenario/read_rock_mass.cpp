#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "block/order.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr Word<block::PlaneState> plane_states[] = {{"plane-stress", block::PlaneState::plane_stress},
                                                    {"plane-strain", block::PlaneState::plane_strain}};
constexpr KeyKind order_kinds[] = {KeyKind::integer, KeyKind::string};
constexpr Word<bool> boundaries[] = {{"frame", true}, {"free", false}};

void read_section(TableReader& t, Scenario& scenario) {
  t.number("azimuth", scenario.section_azimuth,
           {.meaning = "Direction of the +x axis, clockwise from north. Needed for joint sets and for "
                       "horizontal components of records.",
            .unit = "°",
            .at_least = 0.0,
            .at_most = 360.0,
            .usual = &usual::angle});
}

// Cutting rounds to a grid of 2⁻⁴⁴ of the larger extent, and coordinates have 16 digits.
void check_extents(TableReader& t, const Domain& domain) {
  constexpr double least = 1e-6, most = 1e9, least_ratio = 1e-6, least_of_coordinate = 1e-9;
  const std::pair<const char*, const std::pair<double, double>*> sides[] = {{"x", &domain.x},
                                                                            {"y", &domain.y}};
  const double larger = std::max(domain.x.second - domain.x.first, domain.y.second - domain.y.first);
  for (const auto& [key, side] : sides) {
    const double extent = side->second - side->first;
    const double far = std::max(std::abs(side->first), std::abs(side->second));
    const double at_least =
        std::max({least, least_ratio * std::min(larger, most), least_of_coordinate * far});
    if (extent >= at_least && extent <= most) continue;
    t.fail(key, fmt::format("an extent of {} m", extent),
           fmt::format(
               "{:.3g} to {:.0e} m: lengths that can be told apart beside the other side and so far from 0",
               at_least, most));
  }
}

void read_domain(TableReader& t, Scenario& scenario) {
  Domain& domain = scenario.domain.emplace();
  const bool wide = t.interval(
      "x", domain.x,
      {.meaning = "Horizontal extent of the rock.", .unit = "m", .required = true, .usual = &usual::extent});
  const bool high = t.interval(
      "y", domain.y,
      {.meaning = "Vertical extent, y upwards.", .unit = "m", .required = true, .usual = &usual::extent});
  if (wide && high) check_extents(t, domain);
  t.word("boundary", domain.frame, boundaries,
         {.meaning = "`frame`: fixed blocks around the domain, along which the rock can slide but not move "
                     "outwards. `free`: nothing."});
  t.number("frame_friction", domain.frame_friction,
           {.meaning = "Friction angle between the rock and the frame.",
            .unit = "°",
            .at_least = 0.0,
            .below = 90.0,
            .applies = t.documenting() || domain.frame,
            .condition = "boundary = \"frame\"",
            .usual = &usual::friction});
}

constexpr Word<bool> dead_ends[] = {{"remove", false}, {"bridge", true}};

void read_cutting(TableReader& t, CuttingKeys& cutting) {
  t.number("snapping", cutting.snapping,
           {.meaning = "A trace that ends closer than this to another line is made to end on it.",
            .unit = "m",
            .at_least = 0.0,
            .fallback = "5e-5 L"});
  t.number(
      "sliver_area", cutting.sliver_area,
      {.meaning =
           "Blocks of less area are merged into a neighbour: not across a weak plane if there is another "
           "way, nor across a joint that runs through; else the one with the longest common edge.",
       .unit = "m²",
       .at_least = 0.0,
       .fallback = "2.5e-6 L²"});
  t.number("sliver_thickness", cutting.sliver_thickness,
           {.meaning = "Blocks of less area over perimeter are merged, too.",
            .unit = "m",
            .at_least = 0.0,
            .fallback = "2.5e-4 L"});
  t.number("cluster", cutting.cluster,
           {.meaning = "Vertices closer than this become one.",
            .unit = "m",
            .at_least = 0.0,
            .fallback = "2.5e-4 L"});
  t.number("collinear", cutting.collinear,
           {.meaning = "A vertex nearer than this to the straight line between its neighbours is dropped, by "
                       "the blocks on both sides.",
            .unit = "m",
            .at_least = 0.0,
            .fallback = "5e-8 L"});
  t.word(
      "dead_ends", cutting.bridges_dead_ends, dead_ends,
      {.meaning = "What becomes of a joint that ends in rock: `remove`, as it bounds no block, or `bridge`: "
                  "it goes straight on to the next line as a joint with the strength of [rock_bridge]."});
}

void read_region(TableReader& t, RegionSpec& region) {
  t.string("name", region.name, {.meaning = "For the reader of the file."});
  read_polygon(t, region.polygon, true,
               {.meaning = "Outline. Blocks whose centroid is inside take the keys below; where regions "
                           "overlap, those of the last one.",
                .unit = "m",
                .required = true});
  read_rock_keys(t, region.rock, false);
}

}  // namespace

void read_rock_keys(TableReader& t, RockKeys& rock, bool required) {
  const std::string_view inherited = required ? "" : "of [rock]";
  t.number("density", rock.density,
           {.meaning = "Mass per volume.",
            .unit = "kg/m³",
            .required = required,
            .above = 0.0,
            .fallback = inherited,
            .usual = &usual::density});
  t.number("young", rock.young,
           {.meaning = "Young's modulus.",
            .unit = "Pa",
            .required = required,
            .above = 0.0,
            .fallback = inherited,
            .usual = &usual::young});
  t.number("poisson", rock.poisson,
           {.meaning = "Poisson's ratio.",
            .required = required,
            .at_least = 0.0,
            .below = 0.5,
            .fallback = inherited,
            .usual = &usual::poisson});
  t.word("state", rock.state, plane_states,
         {.meaning = "No stress, or no strain, normal to the section. A long tunnel is in plane strain.",
          .fallback = inherited});
  static const std::string order_text =
      fmt::format("an integer from 1 to {}, or \"auto\"", block::highest_order);
  const Value* order =
      t.any("order", std::string_view(order_text).substr(3),
            {.meaning = "Order of the displacement polynomial of a block: 1 has uniform strain, 2 bends, …; "
                        "\"auto\": chosen block by block while the rock settles, see [auto_order].",
             .fallback = required ? "1" : inherited,
             .kinds = order_kinds});
  if (order == nullptr) return;
  if (order->is(Value::Type::string) && order->text == "auto") {
    rock.order = automatic_order;
  } else if (order->is(Value::Type::integer) && order->integer >= 1 &&
             order->integer <= block::highest_order) {
    rock.order = static_cast<int>(order->integer);
  } else {
    t.fail("order", describe(*order), order_text);
  }
}

void read_rock_mass(TableReader& root, Scenario& scenario) {
  root.table("section", {.meaning = "How the section stands in space."},
             [&](TableReader& t) { read_section(t, scenario); });
  root.table("domain",
             {.meaning = "The rectangle that is cut into blocks by joint sets and trace maps. Not needed for "
                         "explicit blocks alone."},
             [&](TableReader& t) { read_domain(t, scenario); });
  scenario.rock.state = block::PlaneState::plane_stress;
  scenario.rock.order = 1;
  root.table("rock", {.meaning = "The rock between the joints.", .required = true},
             [&](TableReader& t) { read_rock_keys(t, scenario.rock, true); });
  read_joints(root, scenario);
  root.table(
      "cutting",
      {.meaning =
           "Tolerances of cutting; 0 switches a step off. L is the square root of the area of the "
           "domain, at most 80 times that area over the length of all traces in it. For "
           "`sliver_area`, `sliver_thickness` and `cluster` L is also at most 80 times the size of the "
           "blocks around: a patch of small blocks in a large domain keeps its blocks. A value that "
           "is given holds everywhere."},
      [&](TableReader& t) { read_cutting(t, scenario.cutting); });
  root.tables(
      "region", scenario.regions,
      {.meaning =
           "A part of the model with rock of its own: any key of [rock]. A block's own keys go before."},
      [&](TableReader& t, RegionSpec& region) { read_region(t, region); });
}

}  // namespace keyblock::scenario
