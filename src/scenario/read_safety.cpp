#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

#include "core/index.h"
#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using record::Stage;
using record::StageKind;

constexpr const char *name_of_reduced = "strength reduced", *name_of_pushed = "seismic coefficient";
/// s; what falls out of an opening has come down by then, and what it held has begun to.
constexpr double longest_motion = 3.0;

/// Where nothing may move, the first block that a static stage names tells. Where some rock may, it has to be let go: a static stage holds what moves,
/// and that props the rock behind it.
Stage stage_of_reduced_strength(const SafetySpec& safety, const Stage& before) {
  Stage stage;
  stage.strength_factor = safety.strength_factor.value_or(1.0);
  stage.strength_of = safety.sets;
  if (safety.area > 0.0) {
    stage.kind = StageKind::rest;
    stage.duration = longest_motion;
    stage.until_still = true;
    return stage;
  }
  stage.tolerance = before.tolerance;
  stage.k_h = safety.k_h.value_or(before.k_h);
  stage.k_v = before.k_v;
  stage.max_steps = safety.max_steps;
  return stage;
}

void read_keys_of_safety(TableReader& t, SafetySpec& safety, const Scenario& scenario) {
  t.reference(
      "stage", safety.stage, "stage",
      {.meaning = "The stage at whose end strength is reduced, of kind `settle`. Later ones are left out.",
       .fallback = "the last one of kind `settle`"});
  const auto given = std::ranges::find(scenario.stages, safety.stage, &Stage::name);
  if (given != scenario.stages.end() && given->kind != StageKind::settle)
    t.fail("stage", "\"" + safety.stage + "\", which is dynamic",
           "a stage of kind \"settle\", as strength is reduced from an equilibrium");
  read_joint_names(
      t, "sets", safety.sets,
      {.meaning = "Whose strength is reduced. The frame keeps its friction.", .fallback = "all joints"});
  t.number(
      "strength_factor", safety.strength_factor,
      {.meaning = "What tan(friction), cohesion and tension, residual strength too, are divided by in a last "
                  "stage. `keyblock safety` looks for the value at which rock moves.",
       .above = 0.0,
       .fallback = "the run is as without [safety]",
       .usual = &usual::strength_factor});
  t.number("k_h", safety.k_h,
           {.meaning = "Horizontal seismic coefficient of that stage: the share of its weight that pushes "
                       "each block to the right. "
                       "`keyblock safety --yield` looks for the value at which rock moves.",
            .fallback = "`k_h` of the stage before",
            .usual = &usual::coefficient});
  t.number(
      "moved", safety.moved,
      {.meaning =
           "Rock has moved that went farther than this in the stage of reduced strength. With `area` this is "
           "not asked.",
       .unit = "m",
       .above = 0.0,
       .fallback = "0.2 % of the block size",
       .usual = &usual::small_way});
  t.number(
      "area", safety.area,
      {.meaning = "So much rock may move. Strength is then reduced in motion, in a stage of kind `rest` in "
                  "the place "
                  "of a static one, which would hold what moves, and so the rock behind it. Rock holds until "
                  "blocks of a larger area have fallen or still move.",
       .unit = "m²",
       .at_least = 0.0});
  t.integer("max_steps", safety.max_steps,
            {.meaning = "Most static steps with reduced strength.", .at_least = 1.0});
}

}  // namespace

void read_joint_names(TableReader& t, std::string_view key, std::vector<std::string>& names,
                      const Rule& rule) {
  std::vector<int> indices;
  t.references(key, indices, names_of_joints, rule);
  const auto all = t.context().list_names.find(names_of_joints);
  for (const int k : indices) names.push_back(all->second[at(k)]);
}

/// Seismic coefficients are loads of static stages, and with an area strength is reduced in motion.
static void check_area(TableReader& root, const Scenario& scenario) {
  const SafetySpec& safety = *scenario.safety;
  const auto stage = std::ranges::find(scenario.stages, safety.stage, &Stage::name);
  const double k_h = safety.k_h.value_or(stage == scenario.stages.end() ? 0.0 : stage->k_h);
  if (safety.area == 0.0 || stage == scenario.stages.end() || (k_h == 0.0 && stage->k_v == 0.0)) return;
  ReadContext& context = root.context();
  context.mistakes.add(
      {context.where("safety.area"), "safety.area",
       fmt::format("an area, with k_h = {} and k_v = {} of the stage '{}'", k_h, stage->k_v, stage->name),
       "0: with an area strength is reduced in motion, where no seismic coefficient acts", ""});
}

void read_safety(TableReader& root, Scenario& scenario) {
  root.table("safety",
             {.meaning = "Factor of safety: strength of joints that is reduced from an equilibrium on "
                         "(`keyblock safety`)."},
             [&](TableReader& t) { read_keys_of_safety(t, scenario.safety.emplace(), scenario); });
  if (!scenario.safety) return;
  if (!scenario.safety->stage.empty()) return check_area(root, scenario);
  const auto last = std::find_if(scenario.stages.rbegin(), scenario.stages.rend(),
                                 [](const Stage& stage) { return stage.kind == StageKind::settle; });
  if (last != scenario.stages.rend()) {
    scenario.safety->stage = last->name;
    check_area(root, scenario);
  } else if (!root.documenting() && root.context().mistakes.empty()) {
    ReadContext& context = root.context();
    context.mistakes.add({context.where("safety"), "safety", "no stage of kind \"settle\"",
                          "one, at whose end strength is reduced", ""});
  }
}

void add_trial_stage(Scenario& scenario) {
  if (!scenario.safety || (!scenario.safety->strength_factor && !scenario.safety->k_h)) return;
  const SafetySpec& safety = *scenario.safety;
  std::vector<Stage>& stages = scenario.stages;
  const auto last = std::ranges::find(stages, safety.stage, &Stage::name);
  if (last == stages.end()) return;
  Stage reduced = stage_of_reduced_strength(safety, *last);
  reduced.name = safety.strength_factor ? name_of_reduced : name_of_pushed;
  while (std::ranges::find(stages, reduced.name, &Stage::name) != stages.end()) reduced.name += " again";
  scenario.left_out.assign(std::next(last), stages.end());
  stages.erase(std::next(last), stages.end());
  stages.push_back(std::move(reduced));
}

}  // namespace keyblock::scenario
