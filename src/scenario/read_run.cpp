#include <fmt/format.h>

#include <algorithm>

#include "core/index.h"
#include "scenario/own_joints.h"
#include "scenario/polygon_checks.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using record::Stage;
using record::StageKind;

constexpr Word<StageKind> stage_kinds[] = {
    {"settle", StageKind::settle}, {"shake", StageKind::shake}, {"rest", StageKind::rest}};
// Whether a history is of absolute motion.
constexpr Word<bool> history_frames[] = {{"relative", false}, {"absolute", true}};
constexpr Word<simulation::ColumnSide> column_sides[] = {{"left", simulation::ColumnSide::left},
                                                         {"right", simulation::ColumnSide::right}};
// Whether a stage ends when all is still.
constexpr Word<bool> stage_ends[] = {{"duration", false}, {"still", true}};
// More steps than this are a slip of the pen.
constexpr double most_steps = 1e9;

void check_excavated_once(TableReader& t, const Stage& stage, const Scenario& scenario) {
  for (const Stage& before : scenario.stages) {
    for (const int index : before.excavate) {
      if (std::find(stage.excavate.begin(), stage.excavate.end(), index) == stage.excavate.end()) continue;
      t.fail(
          "excavate",
          fmt::format("\"{}\" again", t.context().list_names["excavation"][static_cast<std::size_t>(index)]),
          fmt::format("an excavation that the stage '{}' has not taken out", before.name));
    }
  }
}

/// A force that is held while the rock comes to rest.
void check_pretension(TableReader& t, const Stage& stage, const Scenario& scenario) {
  if (stage.kind == StageKind::settle) return;
  for (const BoltSpec& spec : scenario.bolts) {
    if (spec.bolt.pretension > 0.0 && std::ranges::find(stage.install, spec.bolt.list) != stage.install.end())
      t.fail("install", fmt::format("\"{}\", which has pretension", spec.bolt.list),
             "a stage of kind \"settle\" that installs it");
  }
}

/// Supports of all kinds: springs, bolts and liners.
void read_install(TableReader& t, Stage& stage, const Scenario& scenario) {
  std::vector<int> supports;
  t.references(
      "install", supports, names_of_supports,
      {.meaning = "Supports that come to life at the start of the stage, after what it excavates: "
                  "springs, bolts and liners by their names. They have no force as the rock lies then, but "
                  "pretension, and carry what comes later. Before, they are not there."});
  const std::vector<std::string>& names = t.context().list_names[std::string(names_of_supports)];
  for (const int k : supports) {
    const std::string& name = names[static_cast<std::size_t>(k)];
    if (std::ranges::find(scenario.absent, name) == scenario.absent.end()) stage.install.push_back(name);
  }
  check_pretension(t, stage, scenario);
  for (const Stage& before : scenario.stages) {
    for (const std::string& name : before.install) {
      if (std::find(stage.install.begin(), stage.install.end(), name) == stage.install.end()) continue;
      t.fail("install", fmt::format("\"{}\" again", name),
             fmt::format("a support that the stage '{}' has not installed", before.name));
    }
  }
}

/// Until when a dynamic stage lasts.
void read_stillness(TableReader& t, Stage& stage, bool dynamic, bool shake) {
  t.word("until", stage.until_still, stage_ends,
         only(dynamic, "kind = \"shake\" or \"rest\"",
              {.meaning =
                   "`still`: the stage ends before its duration, once nothing moves, slips or turns "
                   "any more. It does not end before a planned load, prescribed displacement or pressure is "
                   "constant, nor before the shaking is over."}));
  const bool still = t.documenting() || stage.until_still;
  t.number(
      "still_time", stage.still_time,
      only(still, "until = \"still\"",
           {.meaning = "So long nothing may move.", .unit = "s", .above = 0.0, .usual = &usual::interval}));
  t.number("still_distance", stage.still_distance,
           only(still, "until = \"still\"",
                {.meaning = "How far a point of a block may go in that time.",
                 .unit = "m",
                 .above = 0.0,
                 .fallback = "a twentieth of [damage] slip",
                 .usual = &usual::small_way}));
  t.number(
      "still_acceleration", stage.still_acceleration,
      only(t.documenting() || (stage.until_still && shake), "until = \"still\" and kind = \"shake\"",
           {.meaning = "The shaking is over when its acceleration stays below this and below a twentieth of "
                       "the largest.",
            .unit = "m/s²",
            .above = 0.0,
            .usual = &usual::acceleration}));
}

/// What a static stage is loaded by beside gravity, and how it ends.
void read_equilibrium(TableReader& t, Stage& stage, bool settle) {
  t.number(
      "k_h", stage.k_h,
      only(settle, "kind = \"settle\"",
           {.meaning =
                "Horizontal seismic coefficient: every block is pushed to the right by this share of its "
                "weight, to the left where it is negative, as long as the stage lasts.",
            .at_least = -10.0,
            .at_most = 10.0,
            .usual = &usual::coefficient}));
  t.number(
      "k_v", stage.k_v,
      only(settle, "kind = \"settle\"",
           {.meaning = "Vertical seismic coefficient, likewise: upwards, downwards where it is negative.",
            .at_least = -10.0,
            .at_most = 10.0,
            .usual = &usual::coefficient}));
  const std::string settle_steps = std::to_string(record::default_settle_steps);
  t.integer("max_steps", stage.max_steps,
            only(settle, "kind = \"settle\"",
                 {.meaning = "Most static steps; the stage ends without equilibrium when they are used up.",
                  .at_least = 1.0,
                  .fallback = settle_steps}));
  t.number("tolerance", stage.tolerance,
           only(settle, "kind = \"settle\"",
                {.meaning = "Equilibrium: largest residual of a block over its weight.",
                 .above = 0.0,
                 .below = 1.0}));
}

/// Strength that is less while the stage lasts.
void read_strength(TableReader& t, Stage& stage) {
  t.number(
      "strength_factor", stage.strength_factor,
      {.meaning = "What tan(friction), cohesion and tension of joints, residual strength too, are divided by "
                  "as long as the stage lasts. The frame keeps its friction.",
       .above = 0.0,
       .usual = &usual::strength_factor});
  const bool is_reduced = t.documenting() || stage.strength_factor != 1.0;
  read_joint_names(
      t, "strength_of", stage.strength_of,
      only(is_reduced, "strength_factor", {.meaning = "Of which joints.", .fallback = "all joints"}));
}

/// From which stage on slip uses the strength of joints up.
void read_wear(TableReader& t, Stage& stage, const Scenario& scenario) {
  const auto weakens = [](const OwnJoints& joints) { return joints.keys.has_residual(); };
  const bool some =
      t.documenting() || scenario.joints.has_residual() || std::ranges::any_of(own_joints(scenario), weakens);
  bool wears = true;
  const bool is_given = t.boolean(
      "wears_joints", wears,
      only(some, "joints that have residual_friction, residual_cohesion or weakening_slip",
           {.meaning = "Whether slip counts for the strength of joints that weaken.",
            .fallback =
                "false while gravity is turned on: in the first `settle` stages, without an excavation, "
                "k_h, k_v, strength_factor or install, before others"}));
  if (is_given) stage.wears_joints = wears;
}

/// A target and a factor contradict each other.
void check_scale(TableReader& t, const Stage& stage, const Scenario& scenario) {
  if (t.find("scale") == nullptr || stage.motion < 0 || at(stage.motion) >= scenario.motions.size()) return;
  const MotionSpec& motion = scenario.motions[at(stage.motion)];
  if (!motion.pga && !motion.pgv) return;
  const char* target = motion.pga ? "pga" : "pgv";
  t.fail("scale",
         fmt::format("a factor on '{}', which has {} = {}", motion.name, target,
                     motion.pga ? *motion.pga : *motion.pgv),
         fmt::format("one of the two: scale, or {} of the motion", target));
}

void read_motion_of_stage(TableReader& t, Stage& stage, const Rule& rule, const Scenario& scenario) {
  std::string motion, suite, first;
  if (const Value* given = t.find("motion"); given != nullptr && given->is(Value::Type::string)) {
    for (const SuiteSpec& spec : scenario.suites) {
      if (spec.name != given->text || spec.records.empty()) continue;
      suite = spec.name;
      first = spec.motion_name(0);
    }
  }
  if (!t.reference("motion", motion, "motion", rule, suite)) return;
  if (motion == suite && !suite.empty()) motion = first;
  const auto& names = t.context().list_names["motion"];
  stage.motion = static_cast<int>(std::find(names.begin(), names.end(), motion) - names.begin());
}

void read_stage(TableReader& t, Stage& stage, const Scenario& scenario) {
  t.name("name", stage.name, "stage", {.meaning = "Name in results and key paths.", .required = true});
  const bool known = t.word(
      "kind", stage.kind, stage_kinds,
      {.meaning = "`settle`: static steps to equilibrium under gravity, loads or in-situ stress; `shake`: "
                  "dynamic under a ground motion; `rest`: dynamic without one.",
       .required = true});
  const bool any = t.documenting() || !known;
  const bool settle = any || stage.kind == StageKind::settle;
  const bool shake = any || stage.kind == StageKind::shake;
  t.references("excavate", stage.excavate, "excavation",
               {.meaning = "Excavations taken out at the start of the stage."});
  check_excavated_once(t, stage, scenario);
  read_install(t, stage, scenario);
  read_release(t, stage, settle, scenario);
  read_motion_of_stage(
      t, stage,
      only(shake, "kind = \"shake\"",
           {.meaning = "The ground motion; of a suite its name, for its first record, or `SUITE/RECORD`.",
            .required = known || t.documenting()}),
      scenario);
  t.number(
      "scale", stage.scale,
      only(shake, "kind = \"shake\"", {.meaning = "Factor on its accelerations.", .usual = &usual::factor}));
  check_scale(t, stage, scenario);
  t.number("duration", stage.duration,
           only(any || stage.kind != StageKind::settle, "kind = \"shake\" or \"rest\"",
                {.meaning = "Duration.",
                 .unit = "s",
                 .required = known && stage.kind == StageKind::rest,
                 .above = 0.0,
                 .fallback = "that of the motion; required to rest",
                 .usual = &usual::duration}));
  read_stillness(t, stage, any || stage.kind != StageKind::settle, shake);
  read_equilibrium(t, stage, settle);
  read_strength(t, stage);
  read_water_of_stage(t, stage, scenario);
  read_wear(t, stage, scenario);
}

void check_step_count(TableReader& t, const Scenario& scenario) {
  double duration = 0.0;
  for (const Stage& stage : scenario.stages) duration += stage.duration.value_or(0.0);
  if (scenario.time_step > 0.0 && duration / scenario.time_step > most_steps) {
    t.fail("step", fmt::format("{:.3g} steps in {} s", duration / scenario.time_step, duration),
           fmt::format("at most {:.0e} steps", most_steps));
  }
}

// With a domain, only the cut blocks tell whether one holds the point.
void check_history(TableReader& t, const simulation::History& history, const Scenario& scenario) {
  if (history.block.empty() && scenario.domain) return;
  bool some_block = false;
  for (const BlockSpec& block : scenario.blocks) {
    if (!history.block.empty() && block.name != history.block) continue;
    if (block.polygon.outer.empty()) return;
    some_block = true;
    if (lies_in(block.polygon, history.point)) return;
  }
  if (!some_block) return;
  t.fail(
      "point", fmt::format("[{}, {}], outside", history.point.x, history.point.y),
      history.block.empty() ? "a point of a block" : fmt::format("a point of the block '{}'", history.block));
}

/// In the place of a point of a block: rock far away.
void read_column(TableReader& t, simulation::History& history, bool applies, const Scenario& scenario) {
  t.word(
      "column", history.column, column_sides,
      {.meaning = "In the place of a point: the rock beside the model, on this side, which moves as if the "
                  "model were not there. It has displacement and velocity, and no stress.",
       .fallback = "none",
       .applies = applies,
       .condition = "no element"});
  const bool given = history.column || t.documenting();
  t.number("y", history.point.y,
           only(given, "column",
                {.meaning = "Height in that rock.",
                 .unit = "m",
                 .required = history.column.has_value(),
                 .fallback = "required with column"}));
  const auto has_columns = [&] {
    return scenario.boundary && (scenario.boundary->sides == record::Sides::free_field ||
                                 scenario.boundary->sides == record::Sides::viscous);
  };
  if (!history.column || has_columns()) return;
  t.fail(
      "column",
      scenario.boundary ? fmt::format("sides = \"{}\"", name_of(scenario.boundary->sides)) : "no [boundary]",
      "a [boundary] with rock beside the model, sides = \"free-field\" or \"viscous\"");
}

/// In the place of a point: an element, any by its name or one of a list of the scenario.
void read_element(TableReader& t, simulation::History& history) {
  std::vector<std::string> given;
  const auto take = [&](const std::string& name) {
    given.push_back(name);
    history.element = name;
  };
  std::string name;
  if (t.string(
          "element", name,
          {.meaning =
               "In the place of a point: what an element carries, its force and elongation. The "
               "name is that in `elements` of summary.json: of a spring, a support, a side of "
               "the boundary (`boundary.base`), a wall under pressure (`tunnel.crown`) or of the water on a "
               "block (`water.dam`).",
           .fallback = "none"}))
    take(name);
  if (t.reference("spring", name, "spring",
                  {.meaning = "The same, for a spring by its name.", .fallback = "none"}))
    take(name);
  if (t.reference("support", name, "support",
                  {.meaning = "The same, for a support by its name.", .fallback = "none"}))
    take(name);
  if (given.size() > 1)
    t.fail("element", fmt::format("{} elements", given.size()),
           "one of the keys element, spring and support");
}

void read_history(TableReader& t, simulation::History& history, const Scenario& scenario) {
  t.name("name", history.name, "history",
         {.meaning = "Name of its columns in histories.csv.", .required = true});
  read_element(t, history);
  const bool of_element =
      t.find("element") != nullptr || t.find("spring") != nullptr || t.find("support") != nullptr;
  read_column(t, history, !of_element, scenario);
  const bool of_block = !history.column && !of_element;
  t.reference("block", history.block, "block",
              only(of_block, "neither column nor element",
                   {.meaning = "The block it belongs to.",
                    .fallback = "the block that holds the point; of several with a common border, one that "
                                "no stage excavates or the one excavated last"}));
  if (t.point("point", history.point,
              only(of_block, "neither column nor element",
                   {.meaning = "Material point, by its place before the run.",
                    .unit = "m",
                    .required = of_block && !t.documenting(),
                    .fallback = "required, or column and y, or element"}))) {
    check_history(t, history, scenario);
  }
  t.word("frame", history.absolute, history_frames,
         only(!of_element, "no element",
              {.meaning =
                   "`relative`: motion against the base, or against the outcrop over a "
                   "compliant base. `absolute`: with the motion of these, the integrals of the record."}));
}

void read_damage(TableReader& t, simulation::DamageLimits& damage) {
  t.number(
      "fall_distance", damage.fall_distance,
      {.meaning = "How far a block has moved when it counts as fallen.",
       .unit = "m",
       .above = 0.0,
       .fallback = "5 % of the width of the opening; without an [[excavation]] half of √(area) of the block",
       .usual = &usual::small_way});
  t.number("loosened_distance", damage.loosened_distance,
           {.meaning = "How far a block has moved when it counts as loosened.",
            .unit = "m",
            .above = 0.0,
            .usual = &usual::small_way});
  t.number("slip", damage.slip,
           {.meaning = "Slip beyond which a joint counts as slipped.",
            .unit = "m",
            .above = 0.0,
            .usual = &usual::small_way});
  t.number("opening", damage.opening,
           {.meaning = "Gap beyond which a joint counts as opened.",
            .unit = "m",
            .above = 0.0,
            .usual = &usual::small_way});
}

void read_output(TableReader& t, simulation::OutputOptions& output) {
  t.number(
      "frame_interval", output.frame_interval,
      {.meaning = "Between frames of dynamic stages.", .unit = "s", .above = 0.0, .usual = &usual::interval});
  t.integer("settle_frame_interval", output.settle_frame_interval,
            {.meaning = "Between frames of static stages.", .unit = "steps", .at_least = 1.0});
  t.number("contact_interval", output.contact_interval,
           {.meaning = "Between snapshots of all contacts; always at the ends of stages.",
            .unit = "s",
            .above = 0.0,
            .usual = &usual::interval});
  t.number("history_interval", output.history_interval,
           {.meaning = "Between rows of histories of dynamic stages; 0: every step. Static stages have a row "
                       "of every step.",
            .unit = "s",
            .at_least = 0.0,
            .usual = &usual::interval});
}

}  // namespace

void read_run(TableReader& root, Scenario& scenario) {
  root.tables(
      "stage", scenario.stages,
      {.meaning = "What happens, one stage after the other. Without stages only `keyblock cut` has work to "
                  "do."},
      [&](TableReader& t, Stage& stage) { read_stage(t, stage, scenario); });
  root.table("time", {.meaning = "Steps.", .required = root.find("stage") != nullptr}, [&](TableReader& t) {
    t.number("step", scenario.time_step,
             {.meaning = "Time step; halved for a while where a step does not converge.",
              .unit = "s",
              .required = true,
              .at_least = 1e-12,
              .at_most = 1e6,
              .usual = &usual::step});
    check_step_count(t, scenario);
  });
  root.tables("history", scenario.histories,
              {.meaning = "A point whose displacement, velocity, stress and acceleration are recorded in "
                          "histories.csv, until a stage excavates its block."},
              [&](TableReader& t, simulation::History& history) { read_history(t, history, scenario); });
  root.table("damage", {.meaning = "Limits of the damage measures."},
             [&](TableReader& t) { read_damage(t, scenario.damage); });
  root.table("output", {.meaning = "How often results are recorded."},
             [&](TableReader& t) { read_output(t, scenario.output); });
  read_solver(root, scenario);
}

}  // namespace keyblock::scenario
