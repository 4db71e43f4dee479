#pragma once
#include <cmath>
#include <limits>

#include "contact/vertex_edge_list.h"

namespace keyblock::contact {

/// Strength of a single contact, in the place of that of its joint: for programs that steer a run. It stays with the vertex and the edge, also
/// while they do not touch. What is not given is not a number: that of the joint.
struct ContactStrength {
  static constexpr double of_joint = std::numeric_limits<double>::quiet_NaN();

  int vertex = 0, edge = 0;
  double friction_coefficient = of_joint;
  double cohesion = of_joint, tension = of_joint;  ///< Pa, of a bond

  static bool is_given(double value) { return !std::isnan(value); }
};

using ContactStrengths = VertexEdgeList<ContactStrength>;

}  // namespace keyblock::contact
