#include <algorithm>
#include <iterator>
#include <string>

#include "core/index.h"
#include "scenario/key_path.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

using simulation::Stage;
using simulation::StageKind;

constexpr const char* name_of_reduced = "strength reduced";

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
                  "static stage. `keyblock safety` looks for the value at which rock moves.",
       .above = 0.0,
       .fallback = "the run is as without [safety]",
       .usual = &usual::strength_factor});
  t.number("moved", safety.moved,
           {.meaning = "Rock has moved that went farther than this in the stage of reduced strength.",
            .unit = "m",
            .above = 0.0,
            .fallback = "0.2 % of the block size",
            .usual = &usual::small_way});
  t.number(
      "area", safety.area,
      {.meaning = "So much rock may move: with it, rock holds until blocks of a larger area move or fall, "
                  "however far others have moved.",
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

void read_safety(TableReader& root, Scenario& scenario) {
  root.table("safety",
             {.meaning = "Factor of safety: strength of joints that is reduced from an equilibrium on "
                         "(`keyblock safety`)."},
             [&](TableReader& t) { read_keys_of_safety(t, scenario.safety.emplace(), scenario); });
  if (!scenario.safety || !scenario.safety->stage.empty()) return;
  const auto last = std::find_if(scenario.stages.rbegin(), scenario.stages.rend(),
                                 [](const Stage& stage) { return stage.kind == StageKind::settle; });
  if (last != scenario.stages.rend()) {
    scenario.safety->stage = last->name;
  } else if (!root.documenting() && root.context().mistakes.empty()) {
    ReadContext& context = root.context();
    context.mistakes.add({context.where("safety"), "safety", "no stage of kind \"settle\"",
                          "one, at whose end strength is reduced", ""});
  }
}

void reduce_strength(Scenario& scenario) {
  if (!scenario.safety || !scenario.safety->strength_factor) return;
  const SafetySpec& safety = *scenario.safety;
  std::vector<Stage>& stages = scenario.stages;
  const auto last = std::ranges::find(stages, safety.stage, &Stage::name);
  if (last == stages.end()) return;
  Stage reduced;
  reduced.name = name_of_reduced;
  while (std::ranges::find(stages, reduced.name, &Stage::name) != stages.end()) reduced.name += " again";
  reduced.tolerance = last->tolerance;
  reduced.k_h = last->k_h;
  reduced.k_v = last->k_v;
  reduced.max_steps = safety.max_steps;
  reduced.strength_factor = *safety.strength_factor;
  reduced.strength_of = safety.sets;
  scenario.left_out.assign(std::next(last), stages.end());
  stages.erase(std::next(last), stages.end());
  stages.push_back(std::move(reduced));
}

}  // namespace keyblock::scenario
