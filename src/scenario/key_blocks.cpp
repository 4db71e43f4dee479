#include "scenario/key_blocks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

#include "core/checked_json.h"
#include "core/index.h"
#include "cutting/edge_name.h"
#include "scenario/joint_table.h"
#include "scenario/own_joints.h"
#include "scenario/properties.h"

namespace keyblock::scenario {
namespace {

using census::Census;
using census::FaceStrength;
using census::KeyBlock;
using census::Mode;
using nlohmann::ordered_json;

constexpr double rad_per_degree = std::numbers::pi / 180.0;

FaceStrength strength(const contact::JointProperties& joint) {
  return {std::tan(joint.friction * rad_per_degree), joint.cohesion};
}

[[noreturn]] void refuse(const Scenario& scenario, const char* key, std::string found, std::string expected) {
  throw InputError(Diagnostic{scenario.where(key), key, std::move(found), std::move(expected), ""});
}

census::Input input_of(const Scenario& scenario, const BlockModel& model, double wanted_factor) {
  census::Input input{.system = model.system};
  for (const simulation::BlockProperties& block : properties_of(scenario, model.system)) {
    input.density.push_back(block.material.density);
    input.fixed.push_back(block.fixed);
  }
  const simulation::JointTable joints = joint_table(scenario, model);
  input.standard = strength(joints.standard);
  for (const contact::JointProperties& joint : joints.joint_sets) input.joint_sets.push_back(strength(joint));
  for (const contact::JointProperties& joint : joints.trace_maps) input.trace_maps.push_back(strength(joint));
  const auto of_traces = [&](const std::vector<std::vector<int>>& traces,
                             const std::vector<FaceStrength>& of_set,
                             std::vector<std::vector<FaceStrength>>& strengths) {
    for (std::size_t k = 0; k < traces.size(); ++k) {
      strengths.emplace_back();
      for (const int place : traces[k])
        strengths.back().push_back(place < 0 ? of_set[k] : strength(joints.of_traces[at(place)].joint));
    }
  };
  of_traces(joints.joint_set_traces, input.joint_sets, input.joint_set_traces);
  of_traces(joints.trace_map_traces, input.trace_maps, input.trace_map_traces);
  input.frame = strength(joints.frame);
  const bool has_frame = scenario.domain && scenario.domain->frame;
  input.rock_around = has_frame || scenario.boundary;
  input.rock_above = has_frame || (scenario.boundary && scenario.boundary->overburden);
  input.gravity = scenario.gravity;
  input.seismic = seismic_coefficients(scenario);
  input.wanted_factor = wanted_factor;
  return input;
}

ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json block_json(const Scenario& scenario, const BlockModel& model, const KeyBlock& key) {
  const Vec2 place = key.centroid + model.system.origin, way = key.removal.direction;
  ordered_json name, layer, direction;
  if (std::string text = block_name(scenario, model, key.block); !text.empty()) name = std::move(text);
  if (key.moves()) layer = key.layer;
  if (key.removal.driving > 0.0) direction = std::atan2(way.y, way.x) / rad_per_degree;
  return {{"block", key.block},
          {"name", name},
          {"layer", layer},
          {"x", place.x},
          {"y", place.y},
          {"area_m2", key.area},
          {"depth_m", key.depth},
          {"weight_n_m", key.weight},
          {"mode", census::mode_name(key.removal.mode)},
          {"factor_of_safety", finite_or_null(key.removal.factor())},
          {"force_n_m", key.force},
          {"direction_deg", direction},
          {"joints", sliding_joints(scenario, key)}};
}

ordered_json totals_json(const Census& census) {
  const census::Totals sum = census::totals(census);
  ordered_json by_mode;
  for (std::size_t m = 0; m < census::modes; ++m)
    by_mode[census::mode_name(static_cast<Mode>(m))] = sum.by_mode[m];
  return {{"moving_blocks", sum.moving},
          {"moving_area_m2", sum.area},
          {"moving_weight_n_m", sum.weight},
          {"first_layer_area_m2", sum.first_layer_area},
          {"blocks_per_m", sum.moving / census.wall},
          {"area_m2_per_m", sum.area / census.wall},
          {"largest_area_m2", sum.largest_area},
          {"largest_depth_m", sum.largest_depth},
          {"deepest_m", sum.deepest},
          {"force_n_m", sum.force},
          {"supported_blocks", sum.supported},
          {"modes", by_mode}};
}

}  // namespace

const char* const census_assumptions =
    "Rigid blocks that move by translation alone, each by itself, under their weight and seismic "
    "coefficients; peak strength of joints, "
    "no stress in the rock, no loads, no support, no water.";

Vec2 seismic_coefficients(const Scenario& scenario) {
  Vec2 found;
  for (const record::Stage& stage : scenario.stages) {
    if (stage.k_h != 0.0 || stage.k_v != 0.0) found = {stage.k_h, stage.k_v};
  }
  return found;
}

census::Census take_census(const Scenario& scenario, const BlockModel& model, double wanted_factor) {
  if (!std::isfinite(wanted_factor))
    refuse(scenario, "--factor", "no number", "the factor of safety that forces are for, a number");
  if (norm(scenario.gravity) == 0.0)
    refuse(scenario, "gravity", "zero", "gravity: a census is of blocks under their weight");
  Census census = census::take_census(input_of(scenario, model, wanted_factor));
  if (census.wall == 0.0)
    refuse(
        scenario, "excavation", scenario.excavations.empty() ? "nothing" : "no wall of rock that is left",
        "rock with a free face for a census of key blocks: an [[excavation]], [boundary] top = \"free\", or "
        "[domain] boundary = \"free\"");
  return census;
}

std::vector<std::string> census_notes(const Scenario& scenario) {
  std::vector<std::string> left_out;
  const bool has_pressure = std::any_of(
      scenario.excavations.begin(), scenario.excavations.end(), [](const ExcavationSpec& excavation) {
        return !excavation.pressure.empty() || !excavation.pressure_by_stage.empty();
      });
  if (!scenario.loads.empty()) left_out.emplace_back("[[load]]");
  if (!scenario.supports.empty()) left_out.emplace_back("[[support]]");
  if (!scenario.springs.empty()) left_out.emplace_back("[[spring]]");
  if (has_pressure) left_out.emplace_back("the pressure of [[excavation]]");
  if (!scenario.waters.empty())
    left_out.emplace_back("[water]: blocks in wet rock have less safety than it says, and need more force");
  if (left_out.empty()) return {};
  return {fmt::format("the census of key blocks leaves out {}", fmt::join(left_out, ", "))};
}

std::vector<std::string> sliding_joints(const Scenario& scenario, const census::KeyBlock& block) {
  const std::vector<std::string> sets = names_of(own_joint_sets(scenario)),
                                 maps = names_of(own_trace_maps(scenario));
  std::vector<std::string> names;
  for (const cutting::EdgeLabel label : block.joints) {
    std::string name = cutting::edge_name(label, sets, maps, {});
    if (name.empty()) name = label.kind == cutting::EdgeKind::domain ? "domain" : "[joints]";
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
  }
  return names;
}

std::string block_name(const Scenario& scenario, const BlockModel& model, int block) {
  // Blocks of the scenario come last.
  const std::size_t first = model.system.blocks.size() - scenario.blocks.size();
  return at(block) < first ? std::string() : scenario.blocks[at(block) - first].name;
}

ordered_json census_json(const Scenario& scenario, int realization, const BlockModel& model,
                         const Census& census, double wanted_factor) {
  const Vec2 seismic = seismic_coefficients(scenario);
  ordered_json blocks = ordered_json::array();
  for (const KeyBlock& key : census.blocks) blocks.push_back(block_json(scenario, model, key));
  return {{"title", scenario.title},
          {"seed", scenario.seed},
          {"realization", realization},
          {"assumptions", census_assumptions},
          {"wanted_factor", wanted_factor},
          {"k_h", seismic.x},
          {"k_v", seismic.y},
          {"wall_m", census.wall},
          {"layers", census.layers},
          {"totals", totals_json(census)},
          {"blocks", blocks}};
}

}  // namespace keyblock::scenario
