#include "simulation/joint_laws.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>

#include "cutting/interfaces.h"

namespace keyblock::simulation {
namespace {

constexpr std::size_t of_joints = 0, of_frame = 1, of_outlines = 2;

double coefficient_of(double friction_angle) {
  return std::tan(friction_angle * std::numbers::pi / 180.0);
}

contact::JointLaw law_of(const contact::JointProperties& joint) {
  contact::JointLaw law{.friction_coefficient = coefficient_of(joint.friction),
                        .cohesion = joint.cohesion,
                        .tension = joint.tension,
                        .normal_stiffness = joint.normal_stiffness.value_or(0.0),
                        .stiffness_ratio = joint.stiffness_ratio};
  if (joint.residual)
    law.residual = contact::JointLaw::Residual{coefficient_of(joint.residual->friction),
                                               joint.residual->cohesion, joint.residual->slip};
  return law;
}

}  // namespace

int law_of_set(cutting::EdgeLabel label) {
  return first_set_law + label.index;
}

int joint_law(const RunSetup& setup, cutting::EdgeLabel label) {
  // An interface is one of two blocks: a third one that touches their edges has nothing of it.
  if (cutting::is_of_interface(setup.system, label)) return static_cast<int>(of_joints);
  const int sets = static_cast<int>(setup.joints.joint_sets.size());
  const int maps = static_cast<int>(setup.joints.trace_maps.size());
  switch (label.kind) {
    case cutting::EdgeKind::free:
    case cutting::EdgeKind::domain:
      return static_cast<int>(of_joints);  // the law of the frame is that of the frame's own edges
    case cutting::EdgeKind::excavation:
      return static_cast<int>(of_outlines);
    case cutting::EdgeKind::joint_set:
    case cutting::EdgeKind::trace_map:
      break;
  }
  if (const int place = setup.joints.place_of_trace(label); place >= 0)
    return first_set_law + sets + maps + place;
  return label.kind == cutting::EdgeKind::joint_set
             ? law_of_set(label)
             : first_set_law + sets + std::min<int>(label.index, maps - 1);
}

int JointTable::place_of_trace(cutting::EdgeLabel label) const {
  const bool is_map = label.kind == cutting::EdgeKind::trace_map;
  if (label.trace < 0 || (!is_map && label.kind != cutting::EdgeKind::joint_set)) return -1;
  const std::vector<std::vector<int>>& traces = is_map ? trace_map_traces : joint_set_traces;
  const auto index = static_cast<std::size_t>(label.index), trace = static_cast<std::size_t>(label.trace);
  return index < traces.size() && trace < traces[index].size() ? traces[index][trace] : -1;
}

std::optional<std::size_t> set_of_law(const RunSetup& setup, std::size_t law) {
  const std::size_t sets = setup.joints.joint_sets.size(), all = sets + setup.joints.trace_maps.size();
  if (law < first_set_law) return std::nullopt;
  if (law < first_set_law + all) return law - first_set_law;
  const cutting::EdgeLabel label = setup.joints.of_traces.at(law - first_set_law - all).label;
  return static_cast<std::size_t>(label.index) + (label.kind == cutting::EdgeKind::trace_map ? sets : 0);
}

std::vector<std::size_t> find_laws(const RunSetup& setup, std::string_view name) {
  if (name == "joints") return {of_joints};
  if (name == "frame") return {of_frame};
  std::size_t set = 0;
  for (const auto* names : {&setup.joint_set_names, &setup.trace_map_names}) {
    const auto found = std::ranges::find(*names, name);
    set += static_cast<std::size_t>(found - names->begin());
    if (found == names->end()) continue;
    std::vector<std::size_t> laws{first_set_law + set};
    const std::size_t first = first_set_law + setup.joints.joint_sets.size() + setup.joints.trace_maps.size();
    for (std::size_t k = 0; k < setup.joints.of_traces.size(); ++k)
      if (set_of_law(setup, first + k) == set) laws.push_back(first + k);
    return laws;
  }
  return {};
}

std::vector<contact::JointLaw> joint_laws(const RunSetup& setup) {
  std::vector<contact::JointLaw> laws{law_of(setup.joints.standard), law_of(setup.joints.frame),
                                      law_of(setup.joints.standard)};
  laws[of_outlines].fused = true;
  std::ranges::transform(setup.joints.joint_sets, std::back_inserter(laws), law_of);
  std::ranges::transform(setup.joints.trace_maps, std::back_inserter(laws), law_of);
  for (const JointTable::OfTraces& of : setup.joints.of_traces) laws.push_back(law_of(of.joint));
  return laws;
}

void put_strength(const Strength& strength, contact::JointLaw& law) {
  law.friction_coefficient = strength.friction_coefficient;
  law.cohesion = strength.cohesion;
  law.tension = strength.tension;
  if (!law.residual) return;
  law.residual->friction_coefficient = std::min(law.residual->friction_coefficient, law.friction_coefficient);
  law.residual->cohesion = std::min(law.residual->cohesion, law.cohesion);
}

std::vector<contact::JointLaw> given_laws(const RunSetup& setup, const ControlMemory& memory) {
  std::vector<contact::JointLaw> laws = joint_laws(setup);
  for (std::size_t k = 0; k < memory.strengths.size(); ++k) put_strength(memory.strengths[k], laws[k]);
  return laws;
}

std::vector<contact::JointLaw> laws_in_stage(const RunSetup& setup, const ControlMemory& memory,
                                             const record::Stage& stage) {
  std::vector<contact::JointLaw> laws = given_laws(setup, memory);
  const auto reduce = [&](std::size_t law) { laws[law] = laws[law].divided_by(stage.strength_factor); };
  for (const std::string& name : stage.strength_of) std::ranges::for_each(find_laws(setup, name), reduce);
  if (!stage.strength_of.empty()) return laws;
  for (std::size_t law = 0; law < laws.size(); ++law)
    if (law != of_frame && law != of_outlines) reduce(law);
  return laws;
}

}  // namespace keyblock::simulation
