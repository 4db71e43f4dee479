#include <fmt/format.h>

#include <algorithm>

#include "scenario/polygon_checks.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using loading::Load;
using loading::Spring;
using loading::Support;

const BlockSpec* find_block(const Scenario& scenario, const std::string& name) {
  const auto block = std::find_if(scenario.blocks.begin(), scenario.blocks.end(),
                                  [&](const BlockSpec& b) { return b.name == name; });
  return name.empty() || block == scenario.blocks.end() || block->polygon.outer.size() < 3 ? nullptr
                                                                                           : &*block;
}

// What is fixed moves as it is told, whatever acts on it.
void check_moves(TableReader& t, const BlockSpec* block) {
  if (block == nullptr || !block->fixed) return;
  t.fail("block", fmt::format("the fixed block '{}'", block->name), "a block that is not fixed");
}

void check_point(TableReader& t, std::string_view key, const BlockSpec* block, Vec2 p) {
  if (block == nullptr || lies_in(block->polygon, p)) return;
  t.fail(key, fmt::format("[{}, {}], outside the block", p.x, p.y),
         fmt::format("a point of the block '{}'", block->name));
}

void check_stretch(TableReader& t, const BlockSpec* block, Vec2 from, Vec2 to) {
  if (from == to) {
    t.fail("to", "the same point as from", "the other end of a stretch of boundary");
    return;
  }
  if (block == nullptr) return;
  for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Vec2 p = lerp(from, to, s);
    if (lies_on_boundary(block->polygon, p)) continue;
    t.fail(s == 0.0 ? "from" : "to", fmt::format("a stretch that leaves the boundary at [{}, {}]", p.x, p.y),
           fmt::format("two points on one straight edge of the block '{}'", block->name));
    return;
  }
}

void read_in_situ(TableReader& t, Scenario& scenario) {
  InSituSpec& in_situ = scenario.in_situ.emplace();
  const bool documenting = t.documenting();
  const bool by_depth = t.find("depth") != nullptr || t.find("k0") != nullptr;
  const bool constant =
      !by_depth && (t.find("sxx") != nullptr || t.find("syy") != nullptr || t.find("sxy") != nullptr);
  t.number(
      "depth", in_situ.depth,
      {.meaning =
           "Rock above the top of the domain: the vertical stress grows downwards by density × gravity, with "
           "the density of `[rock]` everywhere.",
       .unit = "m",
       .required = !constant && !documenting,
       .at_least = 0.0,
       .fallback = "required, or a constant stress",
       .usual = &usual::depth});
  t.number("k0", in_situ.k0,
           {.meaning = "Horizontal over vertical stress.",
            .required = !constant && !documenting,
            .at_least = 0.0,
            .fallback = "required with depth",
            .usual = &usual::stress_ratio});
  const Rule rule{.unit = "Pa",
                  .applies = documenting || !by_depth,
                  .condition = "neither depth nor k0",
                  .usual = &usual::stress};
  const auto stress = [&](std::string_view meaning) {
    Rule r = rule;
    r.meaning = meaning;
    return r;
  };
  t.number("sxx", in_situ.sxx, stress("Constant horizontal stress, compression negative."));
  t.number("syy", in_situ.syy, stress("Constant vertical stress, compression negative."));
  t.number("sxy", in_situ.sxy, stress("Constant shear stress."));
  if (in_situ.depth && scenario.gravity.y >= 0.0) {
    t.fail("depth", "a depth without gravity downwards",
           "gravity = [x, y] with y below 0, or a constant stress");
  }
}

void read_load(TableReader& t, Load& load, const Scenario& scenario) {
  load.is_line = t.find("from") != nullptr || t.find("to") != nullptr || t.find("traction") != nullptr;
  const bool documenting = t.documenting();
  const bool line = load.is_line || documenting, point = !load.is_line || documenting;
  const auto of_point = [&](Rule r) {
    r.applies = point;
    r.condition = "a point load";
    return r;
  };
  const auto of_line = [&](Rule r) {
    r.applies = line;
    r.condition = "a line load";
    return r;
  };
  t.reference("block", load.block, "block",
              {.meaning = "The block it acts on and follows.", .required = true});
  const BlockSpec* block = find_block(scenario, load.block);
  check_moves(t, block);
  if (t.point("point", load.from,
              of_point({.meaning = "Where the force acts.", .unit = "m", .required = true}))) {
    check_point(t, "point", block, load.from);
  }
  t.point(
      "force", load.value,
      of_point(
          {.meaning = "Force per unit thickness.", .unit = "N/m", .required = true, .usual = &usual::force}));
  const bool from = t.point(
      "from", load.from,
      of_line({.meaning = "Start of a straight stretch of boundary.", .unit = "m", .required = true}));
  const bool to = t.point("to", load.to, of_line({.meaning = "Its end.", .unit = "m", .required = true}));
  if (from && to) check_stretch(t, block, load.from, load.to);
  t.point("traction", load.value,
          of_line({.meaning = "Force per area at the start.",
                   .unit = "Pa",
                   .required = true,
                   .usual = &usual::traction}));
  if (!documenting) load.value_end = load.value;
  Rule end{.meaning = "Force per area at the end; linear between.",
           .unit = "Pa",
           .fallback = "as traction",
           .usual = &usual::traction};
  t.point("traction_end", load.value_end, of_line(end));
  t.point(
      "traction_middle", load.value_middle,
      of_line(
          {.meaning =
               "Force per area in the middle; then the traction is the parabola through the three values.",
           .unit = "Pa",
           .fallback = "linear",
           .usual = &usual::traction}));
  TimeRows rows;
  t.time_rows("time", rows, false,
              {.meaning = "Factor over time: rows `[[t, factor], …]`, linear between rows and held outside.",
               .unit = "s",
               .fallback = "1"});
  load.factor = loading::TimeTable(std::move(rows));
}

constexpr KeyKind direction_words[] = {KeyKind::references};

void read_directions(TableReader& t, Support& support) {
  const Value* directions = t.any(
      "directions", "array of \"x\", \"y\"",
      {.meaning = "In which directions it holds.", .fallback = "[\"x\", \"y\"]", .kinds = direction_words});
  if (directions == nullptr) return;
  support.along_x = support.along_y = false;
  bool valid = directions->is(Value::Type::array) && !directions->items.empty();
  if (valid) {
    for (const Value& item : directions->items) {
      const bool x = item.is(Value::Type::string) && item.text == "x";
      const bool y = item.is(Value::Type::string) && item.text == "y";
      support.along_x = support.along_x || x;
      support.along_y = support.along_y || y;
      valid = valid && (x || y);
    }
    valid = valid && directions->items.size() == (support.along_x && support.along_y ? 2U : 1U);
  }
  if (!valid) t.fail("directions", describe(*directions), R"(["x"], ["y"] or ["x", "y"])");
}

loading::TimeTable read_ground_end(TableReader& t, std::string_view key, bool held) {
  TimeRows rows;
  t.time_rows(key, rows, false,
              {.meaning = "Displacement of the ground end: rows `[[t, u], …]`, linear between rows and held "
                          "outside.",
               .unit = "s, m",
               .applies = held || t.documenting(),
               .condition = "this direction held",
               .usual = &usual::way});
  return loading::TimeTable(std::move(rows));
}

void read_support(TableReader& t, Support& support, const Scenario& scenario) {
  support.is_edge = t.find("from") != nullptr || t.find("to") != nullptr;
  const bool documenting = t.documenting();
  t.name("name", support.name, "support",
         {.meaning = "Name in results, and for histories.", .fallback = "support[0] and so on"});
  t.reference("block", support.block, "block", {.meaning = "The block it holds.", .required = true});
  const BlockSpec* block = find_block(scenario, support.block);
  check_moves(t, block);
  if (t.points("points", support.points,
               {.meaning = "Points that are held.",
                .unit = "m",
                .required = !support.is_edge && !documenting,
                .fallback = "required, or from and to",
                .applies = !support.is_edge || documenting,
                .condition = "neither from nor to"})) {
    for (const Vec2 p : support.points) check_point(t, "points", block, p);
  }
  Vec2 ends[2];
  const Rule rule{.meaning = "Start of a straight stretch of boundary that is held.",
                  .unit = "m",
                  .required = support.is_edge || documenting,
                  .applies = support.is_edge || documenting,
                  .condition = "no points"};
  Rule to_rule = rule;
  to_rule.meaning = "Its end.";
  const bool from = t.point("from", ends[0], rule), to = t.point("to", ends[1], to_rule);
  if (from && to) {
    check_stretch(t, block, ends[0], ends[1]);
    support.points = {ends[0], ends[1]};
  }
  read_directions(t, support);
  t.number("stiffness", support.stiffness,
           {.meaning = "Stiffness of the springs at a point, per unit thickness, or along a stretch.",
            .unit = "N/m per m; Pa/m",
            .above = 0.0,
            .fallback = "1000 young",
            .usual = support.is_edge ? &usual::bed_stiffness : &usual::spring_stiffness});
  t.table("motion", {.meaning = "Prescribed displacement of the ground end of the springs."},
          [&](TableReader& m) {
            support.motion_x = read_ground_end(m, "x", support.along_x);
            support.motion_y = read_ground_end(m, "y", support.along_y);
          });
}

/// The block of one end, if it is named.
const BlockSpec* read_end(TableReader& t, std::string_view key, Vec2& point, std::string_view block_key,
                          std::string& name, std::string_view which, const Scenario& scenario) {
  const bool given = t.point(key, point, {.meaning = which, .unit = "m", .required = true});
  t.reference(block_key, name, "block",
              {.meaning = "The block of that end.",
               .fallback = "the block that holds the point; of several, one that no stage excavates or the "
                           "one excavated last"});
  const BlockSpec* block = find_block(scenario, name);
  if (given) check_point(t, key, block, point);
  return block;
}

void read_spring(TableReader& t, Spring& spring, Scenario& scenario) {
  t.name("name", spring.name, "spring",
         {.meaning = "Name, by which a stage installs it. A spring that no stage installs is there from the "
                     "start.",
          .fallback = "none"});
  read_present(t, spring.name, scenario);
  const BlockSpec* from = read_end(t, "from", spring.from, "from_block", spring.from_block,
                                   "One end, a point of a block.", scenario);
  const BlockSpec* to = read_end(t, "to", spring.to, "to_block", spring.to_block,
                                 "The other end, a point of another block.", scenario);
  if (from != nullptr && from == to)
    t.fail("to_block", fmt::format("the block '{}' at both ends", to->name), "another block");
  if (spring.from == spring.to && t.find("from") != nullptr && t.find("to") != nullptr)
    t.fail("to", "the same point as from", "a point of another block at a distance");
  t.number("stiffness", spring.stiffness,
           {.meaning = "Force per elongation, per unit thickness.",
            .unit = "N/m per m",
            .required = true,
            .above = 0.0,
            .usual = &usual::spring_stiffness});
  t.number(
      "yield", spring.yield,
      {.meaning = "Largest force, in tension and compression, per unit thickness. At it the spring yields "
                  "and keeps its elongation.",
       .unit = "N/m",
       .above = 0.0,
       .fallback = "it never yields",
       .usual = &usual::yield});
}

}  // namespace

void read_present(TableReader& t, const std::string& name, Scenario& scenario) {
  bool is_present = true;
  t.boolean("present", is_present,
            {.meaning = "false: the run is without it, whatever stages install. So a study compares "
                        "supports: `key = \"bolt.crown.present\"`, `values = [false, true]`."});
  if (is_present) return;
  if (name.empty()) t.fail("present", "false, of a support without a name", "a `name` as well");
  scenario.absent.push_back(name);
}

void read_loading(TableReader& root, Scenario& scenario) {
  root.table(
      "in_situ",
      {.meaning = "Stress before excavation. Without it the rock carries its own weight alone, and the "
                  "crown of an opening in cohesionless joints is marginal."},
      [&](TableReader& t) { read_in_situ(t, scenario); });
  read_water(root, scenario);
  root.tables("motion", scenario.motions,
              {.meaning = "A motion of the base: a record with its components, or the acceleration in x and "
                          "y: rows, a sine, or a file."},
              [](TableReader& t, MotionSpec& motion) { read_motion(t, motion); });
  read_suites(root, scenario);
  root.number(
      "load_factor", scenario.load_factor,
      {.meaning = "All [[load]] are multiplied by it.", .at_least = 0.0, .usual = &usual::load_factor});
  root.tables(
      "load", scenario.loads,
      {.meaning = "A force at a point of a block, or a traction along a straight stretch of its boundary. "
                  "Per unit thickness; it follows the block."},
      [&](TableReader& t, Load& load) { read_load(t, load, scenario); });
  root.tables("support", scenario.supports,
              {.meaning = "Springs from points, or from a straight stretch of boundary, to the ground."},
              [&](TableReader& t, Support& support) { read_support(t, support, scenario); });
  root.tables(
      "spring", scenario.springs,
      {.meaning = "A straight spring between points of two blocks, without force at the start, or as a stage "
                  "installs it. It turns with the line between its ends. It ends where a block of it is "
                  "excavated."},
      [&](TableReader& t, Spring& spring) { read_spring(t, spring, scenario); });
  read_bolts(root, scenario);
  read_liners(root, scenario);
}

}  // namespace keyblock::scenario
