#pragma once
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace keyblock::scenario {

/// Joints with properties of their own.
struct OwnJoints {
  const std::string& name;
  const std::string& path;
  const JointKeys& keys;
};

/// Joint sets, then what is like one without traces: rock bridges, and interfaces. In the order of EdgeLabel::index.
std::vector<OwnJoints> own_joint_sets(const Scenario& scenario);
std::vector<OwnJoints> own_trace_maps(const Scenario& scenario);
/// The first, then the second: in the order of the laws of joints.
std::vector<OwnJoints> own_joints(const Scenario& scenario);

/// The label of edges along rock bridges, and along the first interface.
cutting::EdgeLabel label_of_bridges(const Scenario& scenario);
cutting::EdgeLabel label_of_first_interface(const Scenario& scenario);

std::vector<std::string> names_of(const std::vector<OwnJoints>& joints);

}  // namespace keyblock::scenario
