#include "scenario/own_joints.h"

namespace keyblock::scenario {

std::vector<OwnJoints> own_joint_sets(const Scenario& scenario) {
  std::vector<OwnJoints> all;
  for (const JointSetSpec& spec : scenario.joint_sets) all.push_back({spec.set.name, spec.path, spec.joints});
  if (scenario.rock_bridge)
    all.push_back({scenario.rock_bridge->name, scenario.rock_bridge->path, scenario.rock_bridge->joints});
  for (const InterfaceSpec& spec : scenario.interfaces) all.push_back({spec.name, spec.path, spec.joints});
  return all;
}

std::vector<OwnJoints> own_trace_maps(const Scenario& scenario) {
  std::vector<OwnJoints> all;
  for (const TraceMapSpec& spec : scenario.trace_maps) all.push_back({spec.name, spec.path, spec.joints});
  return all;
}

std::vector<OwnJoints> own_joints(const Scenario& scenario) {
  std::vector<OwnJoints> all = own_joint_sets(scenario);
  for (const OwnJoints& map : own_trace_maps(scenario)) all.push_back(map);
  return all;
}

cutting::EdgeLabel label_of_bridges(const Scenario& scenario) {
  return {cutting::EdgeKind::joint_set, static_cast<std::int16_t>(scenario.joint_sets.size())};
}

cutting::EdgeLabel label_of_first_interface(const Scenario& scenario) {
  cutting::EdgeLabel label = label_of_bridges(scenario);
  if (scenario.rock_bridge) ++label.index;
  return label;
}

std::vector<std::string> names_of(const std::vector<OwnJoints>& joints) {
  std::vector<std::string> names;
  for (const OwnJoints& joint : joints) names.push_back(joint.name);
  return names;
}

}  // namespace keyblock::scenario
