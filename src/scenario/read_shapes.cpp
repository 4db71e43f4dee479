#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "scenario/polygon_checks.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

constexpr int fewest_chords = 8, most_chords = 10000;

constexpr Word<ExcavationShape> shapes[] = {{"circle", ExcavationShape::circle},
                                            {"polygon", ExcavationShape::polygon},
                                            {"horseshoe", ExcavationShape::horseshoe},
                                            {"file", ExcavationShape::file},
                                            {"slope", ExcavationShape::slope}};

void read_circle(TableReader& t, ExcavationSpec& spec, const auto& rule) {
  t.point("center", spec.center,
          rule(ExcavationShape::circle, {.meaning = "Centre.", .unit = "m", .required = true}));
  t.number(
      "diameter", spec.diameter,
      rule(ExcavationShape::circle,
           {.meaning = "Diameter.", .unit = "m", .required = true, .above = 0.0, .usual = &usual::opening}));
}

void read_horseshoe(TableReader& t, ExcavationSpec& spec, const auto& rule) {
  constexpr auto horseshoe = ExcavationShape::horseshoe;
  t.point("invert", spec.invert,
          rule(horseshoe, {.meaning = "Middle of the floor.", .unit = "m", .required = true}));
  t.number("width", spec.width,
           rule(horseshoe, {.meaning = "Width of the floor.",
                            .unit = "m",
                            .required = true,
                            .above = 0.0,
                            .usual = &usual::opening}));
  t.number("wall_height", spec.wall_height,
           rule(horseshoe, {.meaning = "Height of the vertical walls.",
                            .unit = "m",
                            .required = true,
                            .at_least = 0.0,
                            .usual = &usual::opening}));
  const bool rise =
      t.number("arch_height", spec.arch_height,
               rule(horseshoe, {.meaning = "Rise of the circular arch above the walls, at most half "
                                           "the width.",
                                .unit = "m",
                                .above = 0.0,
                                .fallback = "width / 2",
                                .usual = &usual::opening}));
  if (rise && spec.width > 0.0 && *spec.arch_height > 0.5 * spec.width) {
    t.fail("arch_height", fmt::format("the number {}", *spec.arch_height),
           fmt::format("at most half the width, {}", 0.5 * spec.width));
  }
}

constexpr Word<bool> sides[] = {{"right", true}, {"left", false}};

void read_slope(TableReader& t, SlopeShape& slope, const auto& rule) {
  constexpr auto shape = ExcavationShape::slope;
  const auto length = [&](std::string_view meaning) {
    return rule(shape,
                {.meaning = meaning, .unit = "m", .required = true, .above = 0.0, .usual = &usual::extent});
  };
  t.point("toe", slope.toe,
          rule(shape, {.meaning = "Foot of the lowest bench.", .unit = "m", .required = true}));
  t.word("rises_to", slope.rises_to_the_right, sides,
         rule(shape, {.meaning = "Side to which the slope rises."}));
  t.number("floor", slope.floor, length("From the toe to the other side, as far as rock is taken away."));
  t.number("face_angle", slope.face_angle,
           rule(shape, {.meaning = "Of each bench, from the horizontal.",
                        .unit = "°",
                        .above = 0.0,
                        .at_most = 90.0,
                        .usual = &usual::angle}));
  t.number("bench_height", slope.bench_height, length("Of each bench."));
  t.number("berm", slope.berm,
           rule(shape, {.meaning = "Width of the step between two benches.",
                        .unit = "m",
                        .at_least = 0.0,
                        .usual = &usual::extent}));
  t.integer("benches", slope.benches, rule(shape, {.meaning = "How many.", .at_least = 1, .at_most = 1000}));
}

void read_outline_file(TableReader& t, ExcavationSpec& spec, const Rule& rule, Scenario& scenario) {
  std::filesystem::path file;
  rockmass::MapChoice choice;
  const bool there = t.file("file", file, rule);
  read_map_choice(t, choice, rule.applies, rule.condition);
  if (there && spec.shape == ExcavationShape::file) read_drawn_outline(t, spec, choice, file, scenario);
}

void read_excavation(TableReader& t, ExcavationSpec& spec, Scenario& scenario) {
  spec.path = t.path();
  t.name("name", spec.name, "excavation",
         {.meaning = "Name, for the stages that excavate it.", .required = true});
  const bool known =
      t.word("shape", spec.shape, shapes, {.meaning = "Shape of the outline.", .required = true});
  const auto rule = [&](ExcavationShape shape, Rule r) {
    const auto word =
        std::find_if(std::begin(shapes), std::end(shapes), [&](const auto& w) { return w.value == shape; });
    static constexpr std::string_view conditions[] = {"shape = \"circle\"", "shape = \"polygon\"",
                                                      "shape = \"horseshoe\"", "shape = \"file\"",
                                                      "shape = \"slope\""};
    r.condition = conditions[word - std::begin(shapes)];
    r.applies = t.documenting() || !known || spec.shape == shape;
    r.required = r.required && (t.documenting() || known);
    return r;
  };
  read_circle(t, spec, rule);
  Polygon polygon;
  const Rule outer{.meaning = "Vertices, either way round.", .unit = "m", .required = true};
  read_polygon(t, polygon, false, rule(ExcavationShape::polygon, outer));
  spec.outer = std::move(polygon.outer);
  read_horseshoe(t, spec, rule);
  read_outline_file(
      t, spec,
      rule(ExcavationShape::file,
           {.meaning = "A drawing (ASCII DXF) or a shapefile with one closed line, the outline.",
            .required = true}),
      scenario);
  read_slope(t, spec.slope, rule);
  const bool round =
      t.documenting() || spec.shape == ExcavationShape::circle || spec.shape == ExcavationShape::horseshoe;
  t.integer("chords", spec.chords,
            {.meaning = "Chords of a full circle.",
             .at_least = fewest_chords,
             .at_most = most_chords,
             .applies = round,
             .condition = "shape = \"circle\" or \"horseshoe\""});
  read_pressure(t, spec);
  bool filled = false;
  if (t.boolean(
          "filled", filled,
          {.meaning = "Once it is open, it stands full of the water of [water], which presses on its wall "
                      "as in the joints behind it. Else its wall is drained."}))
    spec.filled = filled;
}

loading::TimeTable read_prescribed(TableReader& t, std::string_view key) {
  TimeRows rows;
  t.time_rows(
      key, rows, false,
      {.meaning = "Displacement of the block: rows `[[t, u], …]`, linear between rows and held outside; it "
                  "is zero at time 0.",
       .unit = "s, m",
       .usual = &usual::way});
  loading::TimeTable table(std::move(rows));
  if (!table.empty() && table(0.0) != 0.0) {
    t.fail(key, fmt::format("a displacement of {} at time 0", table(0.0)), "a displacement that begins at 0");
  }
  return table;
}

/// Turns the outline counter-clockwise, about the centroid where no centre is given.
void read_rotation(TableReader& t, BlockSpec& block) {
  double degrees = 0.0;
  std::optional<Vec2> centre;
  t.number("rotation", degrees,
           {.meaning =
                "Angle by which the outline is turned before the run, counter-clockwise. Loads, supports and "
                "histories are given by points of the turned block.",
            .unit = "°",
            .at_least = -360.0,
            .at_most = 360.0,
            .usual = &usual::angle});
  t.point("rotation_center", centre,
          {.meaning = "Point about which it is turned.",
           .unit = "m",
           .fallback = "its centroid",
           .applies = t.documenting() || t.find("rotation") != nullptr,
           .condition = "rotation"});
  if (degrees == 0.0 || block.polygon.outer.size() < 3) return;
  const double angle = degrees * std::numbers::pi / 180.0;
  const Vec2 about = centre.value_or(centroid(block.polygon));
  const Vec2 turned_x{std::cos(angle), std::sin(angle)};
  const auto turn = [&](Ring& ring) {
    for (Vec2& p : ring) p = about + (p.x - about.x) * turned_x + (p.y - about.y) * perpendicular(turned_x);
  };
  turn(block.polygon.outer);
  for (Ring& hole : block.polygon.holes) turn(hole);
}

void read_block(TableReader& t, BlockSpec& block) {
  block.path = t.path();
  t.name("name", block.name, "block", {.meaning = "Name, for loads, supports and histories."});
  read_polygon(t, block.polygon, true,
               {.meaning = "Vertices, either way round.", .unit = "m", .required = true});
  read_rotation(t, block);
  if (const Value* fixed = t.find("fixed"); fixed != nullptr && fixed->boolean) t.judge_nothing();
  read_rock_keys(t, block.rock, false);
  t.boolean("fixed", block.fixed, {.meaning = "The block neither moves nor deforms, but by `motion`."});
  const bool moves = t.documenting() || !block.fixed;
  t.table("motion",
          {.meaning = "Prescribed displacement of a fixed block; it moves rigidly, and relative to the base.",
           .applies = t.documenting() || block.fixed,
           .condition = "fixed = true"},
          [&](TableReader& m) {
            block.motion_x = read_prescribed(m, "x");
            block.motion_y = read_prescribed(m, "y");
            if (!m.documenting() && m.find("x") == nullptr && m.find("y") == nullptr) {
              m.missing("x", "rows [[t, u], …] in x or y");
            }
          });
  t.point("velocity", block.velocity,
          {.meaning = "Velocity of the centroid at the start.",
           .unit = "m/s",
           .applies = moves,
           .condition = "fixed = false",
           .usual = &usual::block_velocity});
  t.number("spin", block.spin,
           {.meaning = "Angular velocity at the start, counter-clockwise.",
            .unit = "rad/s",
            .applies = moves,
            .condition = "fixed = false"});
}

}  // namespace

void read_polygon(TableReader& t, Polygon& polygon, bool holes, const Rule& outer_rule) {
  bool valid = t.ring("outer", polygon.outer, outer_rule);
  if (holes) {
    const bool has_holes = t.find("holes") != nullptr;
    const bool valid_holes =
        t.rings("holes", polygon.holes, {.meaning = "Holes: an array of rings.", .unit = "m"});
    valid = valid && (!has_holes || valid_holes);
  }
  if (!valid) return;
  if (const auto fault = orient_and_check(polygon)) {
    t.fail(fault->in_holes ? "holes" : "outer", fault->text, "rings that enclose an area and do not cross");
  }
}

Ring slope_outline(const SlopeShape& slope) {
  constexpr double vertical = 90.0;
  const double setback = slope.face_angle == vertical
                             ? 0.0
                             : slope.bench_height / std::tan(slope.face_angle * std::numbers::pi / 180.0);
  const double side = slope.rises_to_the_right ? 1.0 : -1.0;
  Ring ring{slope.toe - Vec2{side * slope.floor, 0.0}, slope.toe};
  for (int k = 0; k < slope.benches; ++k) {
    if (k > 0 && slope.berm > 0.0) ring.push_back(ring.back() + Vec2{side * slope.berm, 0.0});
    ring.push_back(ring.back() + Vec2{side * setback, slope.bench_height});
  }
  ring.push_back({ring.front().x, ring.back().y});
  if (!slope.rises_to_the_right) std::ranges::reverse(ring);
  return ring;
}

Ring excavation_outline(const ExcavationSpec& spec) {
  constexpr double pi = std::numbers::pi;
  if (spec.shape == ExcavationShape::slope) return slope_outline(spec.slope);
  if (spec.shape == ExcavationShape::polygon || spec.shape == ExcavationShape::file) return spec.outer;
  Ring ring;
  if (spec.shape == ExcavationShape::circle) {
    for (int k = 0; k < spec.chords; ++k) {
      const double angle = 2.0 * pi * k / spec.chords;
      ring.push_back(spec.center + 0.5 * spec.diameter * Vec2{std::cos(angle), std::sin(angle)});
    }
    return ring;
  }
  // Arch: radius r and half angle α from the rise h over the half width w: r = (w² + h²)/2h, sin α = w/r.
  const double w = 0.5 * spec.width;
  const double h = spec.arch_height.value_or(w);
  const double r = (w * w + h * h) / (2.0 * h);
  const double half_angle = std::atan2(w, r - h);
  const Vec2 centre = spec.invert + Vec2{0.0, spec.wall_height + h - r};
  ring = {spec.invert - Vec2{w, 0.0}, spec.invert + Vec2{w, 0.0}};
  const int chords = std::max(2, static_cast<int>(std::ceil(spec.chords * half_angle / pi)));
  for (int k = spec.wall_height > 0.0 ? 0 : 1; k <= chords; ++k) {
    const double angle = half_angle * (2.0 * k / chords - 1.0);
    ring.push_back(centre + r * Vec2{-std::sin(angle), std::cos(angle)});
  }
  if (spec.wall_height == 0.0) ring.pop_back();
  return ring;
}

void read_shapes(TableReader& root, Scenario& scenario) {
  root.tables("excavation", scenario.excavations,
              {.meaning = "An opening. Its outline is cut into the domain from the start; a stage takes the "
                          "rock out. Explicit "
                          "blocks are not cut: those that lie in it are taken out whole, and one that lies "
                          "in it in part, or is "
                          "fixed, is a mistake."},
              [&](TableReader& t, ExcavationSpec& spec) { read_excavation(t, spec, scenario); });
  root.tables("block", scenario.blocks,
              {.meaning = "A block given by its outline, beside those cut from the domain or alone."},
              [](TableReader& t, BlockSpec& block) { read_block(t, block); });
  read_block_maps(root, scenario);
}

}  // namespace keyblock::scenario
