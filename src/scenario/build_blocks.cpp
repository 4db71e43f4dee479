#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/out_of_memory.h"
#include "cutting/cut.h"
#include "cutting/interfaces.h"
#include "rockmass/intensity.h"
#include "rockmass/trace_generator.h"
#include "scenario/build.h"
#include "scenario/excavated_blocks.h"
#include "scenario/expected_blocks.h"
#include "scenario/inputs.h"
#include "scenario/key_path.h"
#include "scenario/own_joints.h"
#include "scenario/sections.h"

namespace keyblock::scenario {
namespace {

// Blocks farther from the origin than this many times their extent get a local origin.
constexpr double far_away = 1000.0;

Ring shifted(Ring ring, Vec2 by) {
  for (Vec2& p : ring) p += by;
  return ring;
}

cutting::CutTolerances tolerances_of(const CuttingKeys& keys, const Box& window,
                                     const std::vector<rockmass::Trace>& traces) {
  double trace_length = 0.0;
  for (const rockmass::Trace& trace : traces) trace_length += rockmass::length_inside(trace, window);
  cutting::CutTolerances tolerances =
      cutting::CutTolerances::for_domain(window.size().x * window.size().y, trace_length);
  tolerances.snapping = keys.snapping.value_or(tolerances.snapping);
  tolerances.sliver_area = keys.sliver_area.value_or(tolerances.sliver_area);
  tolerances.sliver_thickness = keys.sliver_thickness.value_or(tolerances.sliver_thickness);
  tolerances.cluster = keys.cluster.value_or(tolerances.cluster);
  tolerances.sliver_area_is_given = keys.sliver_area.has_value();
  tolerances.sliver_thickness_is_given = keys.sliver_thickness.has_value();
  tolerances.cluster_is_given = keys.cluster.has_value();
  tolerances.collinear = keys.collinear.value_or(tolerances.collinear);
  return tolerances;
}

// Stress at which joints are compared: the weight of the rock down to the middle of the domain. Where nothing has weight, any will do
// that makes friction count beside the cohesion of weak joints.
double normal_stress_of_comparison(const Scenario& scenario) {
  constexpr double without_weight = 1e5;
  const double depth = scenario.in_situ ? scenario.in_situ->depth.value_or(0.0) : 0.0;
  const double middle = depth + 0.5 * scenario.domain->box().size().y;
  const double stress = scenario.rock.density.value_or(0.0) * norm(scenario.gravity) * middle;
  return stress > 0.0 ? stress : without_weight;
}

cutting::JointStrengths joint_strengths(const Scenario& scenario) {
  const double stress = normal_stress_of_comparison(scenario);
  const auto strength = [&](const JointKeys& own) {
    const double friction = own.friction.value_or(scenario.joints.friction.value_or(0.0));
    return own.cohesion.value_or(scenario.joints.cohesion.value_or(0.0)) +
           stress * std::tan(friction * std::numbers::pi / 180.0);
  };
  cutting::JointStrengths strengths{.standard = strength({})};
  for (const OwnJoints& joints : own_joint_sets(scenario))
    strengths.joint_sets.push_back(strength(joints.keys));
  // No interface is cut, and none may say that joints differ.
  strengths.joint_sets.resize(static_cast<std::size_t>(label_of_first_interface(scenario).index));
  for (const OwnJoints& joints : own_trace_maps(scenario))
    strengths.trace_maps.push_back(strength(joints.keys));
  return strengths;
}

// What the generator refuses shows at the joint set in the file.
std::vector<rockmass::Trace> generate(const Scenario& scenario, std::size_t k, const Box& window,
                                      int realization) {
  const JointSetSpec& spec = scenario.joint_sets[k];
  try {
    return rockmass::generate_traces(spec.set, static_cast<int>(k), *scenario.section_azimuth, window,
                                     scenario.seed, realization);
  } catch (const InputError& error) {
    std::vector<Diagnostic> diagnostics = error.diagnostics();
    for (Diagnostic& diagnostic : diagnostics) {
      diagnostic.key = spec.path;
      diagnostic.where = scenario.where(spec.path);
    }
    throw InputError(std::move(diagnostics));
  }
}

cutting::BridgeInput bridges_of(const Scenario& scenario, const Box& window, int realization) {
  cutting::BridgeInput bridges{.label = label_of_bridges(scenario),
                               .at_dead_ends = scenario.cutting.bridges_dead_ends};
  for (std::size_t k = 0; k < scenario.joint_sets.size(); ++k) {
    const JointSetSpec& spec = scenario.joint_sets[k];
    if (!spec.gap_bonds) continue;
    const auto gaps = rockmass::gaps_of_traces(spec.set, static_cast<int>(k), *scenario.section_azimuth,
                                               window, scenario.seed, realization);
    bridges.in_gaps.insert(bridges.in_gaps.end(), gaps.begin(), gaps.end());
  }
  return bridges;
}

// What the cutter refuses, an outline of no size beside the domain, shows at the excavation in the file.
InputError placed(const Scenario& scenario, const InputError& error) {
  std::vector<Diagnostic> diagnostics = error.diagnostics();
  for (Diagnostic& diagnostic : diagnostics) {
    for (std::size_t k = 0; k < scenario.excavations.size(); ++k) {
      if (diagnostic.key == join_index("excavation", k)) diagnostic.key = scenario.excavations[k].path;
    }
    diagnostic.where = scenario.where(diagnostic.key);
  }
  return InputError(std::move(diagnostics));
}

// A model of far too many blocks is refused before it is cut: that would take minutes and gigabytes.
void check_expected_blocks(const Scenario& scenario, const cutting::CutInput& input, const Box& window) {
  constexpr double least_unknowns = 6.0;  // of a block
  constexpr double clearly = 1.5;
  const double most_blocks = clearly * most_unknowns / least_unknowns;
  const double traces = static_cast<double>(input.traces.size());
  if (traces * (traces + 1.0) / 2.0 + 1.0 <= most_blocks) return;
  const double blocks = expected_blocks(input.traces, window, *input.tolerances);
  if (blocks <= most_blocks) return;
  throw InputError(Diagnostic{
      scenario.where("domain"), "domain",
      fmt::format("joints that cut it into {:.2g} blocks or more, with {:.2g} unknowns (an estimate)", blocks,
                  least_unknowns * blocks),
      fmt::format("at most {:.0e} unknowns", most_unknowns), "joints farther apart, or a smaller domain"});
}

void cut_domain(const Scenario& scenario, int realization, BlockModel& model) {
  const Domain& domain = *scenario.domain;
  const Box window = domain.box();
  for (std::size_t k = 0; k < scenario.joint_sets.size(); ++k) {
    const auto set = generate(scenario, k, window, realization);
    model.traces.insert(model.traces.end(), set.begin(), set.end());
  }
  const auto mapped = read_trace_maps(scenario, &model.map_strengths, &model.skipped, realization);
  model.traces.insert(model.traces.end(), mapped.begin(), mapped.end());

  cutting::CutInput input;
  input.domain = {window.min, {window.max.x, window.min.y}, window.max, {window.min.x, window.max.y}};
  input.traces = model.traces;
  input.excavations = model.outlines;
  input.tolerances = tolerances_of(scenario.cutting, window, model.traces);
  input.strengths = joint_strengths(scenario);
  if (scenario.rock_bridge) input.bridges = bridges_of(scenario, window, realization);
  check_expected_blocks(scenario, input, window);
  try {
    model.system =
        with_memory_for([&] { return fmt::format("the cutting of {} traces", input.traces.size()); },
                        [&] { return cutting::cut(input); });
  } catch (const InputError& error) {
    throw placed(scenario, error);
  }
}

Vec2 origin_of(const std::vector<BlockSpec>& blocks) {
  Box box;
  for (const BlockSpec& block : blocks) box.add(bounds(block.polygon));
  const double size = std::max(box.size().x, box.size().y);
  if (norm(box.min) <= far_away * size) return {};
  return {std::round(box.min.x), std::round(box.min.y)};
}

cutting::CutBlock explicit_block(const BlockSpec& spec, const std::vector<Ring>& outlines, Vec2 origin) {
  cutting::CutBlock block;
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    if (overlay(spec.polygon, outlines[k]).place == Place::inside)
      block.excavations.push_back(static_cast<int>(k));
  }
  block.polygon.outer = shifted(spec.polygon.outer, -origin);
  for (const Ring& hole : spec.polygon.holes) block.polygon.holes.push_back(shifted(hole, -origin));
  for (std::size_t r = 0; r < block.polygon.ring_count(); ++r) {
    block.labels.emplace_back(block.polygon.ring(r).size());
  }
  return block;
}

void place_interfaces(const Scenario& scenario, cutting::BlockSystem& system) {
  const std::size_t first = system.blocks.size() - scenario.blocks.size();
  const auto number = [&](const std::string& name) {
    const auto block = std::ranges::find(scenario.blocks, name, &BlockSpec::name);
    return first + static_cast<std::size_t>(block - scenario.blocks.begin());
  };
  cutting::EdgeLabel joint = label_of_first_interface(scenario);
  for (const InterfaceSpec& spec : scenario.interfaces) {
    const auto [low, high] = std::minmax({number(spec.between.first), number(spec.between.second)});
    system.interfaces.push_back({low, high, joint});
    ++joint.index;
  }
  cutting::label_interfaces(system);
}

}  // namespace

BlockModel build_blocks(const Scenario& scenario, int realization) {
  BlockModel model;
  model.realization = realization;
  for (const ExcavationSpec& spec : scenario.excavations) model.outlines.push_back(excavation_outline(spec));
  if (scenario.domain) {
    cut_domain(scenario, realization, model);
  } else {
    model.system.origin = origin_of(scenario.blocks);
  }
  for (const BlockSpec& spec : scenario.blocks) {
    model.system.blocks.push_back(explicit_block(spec, model.outlines, model.system.origin));
  }
  place_interfaces(scenario, model.system);
  return model;
}

}  // namespace keyblock::scenario
