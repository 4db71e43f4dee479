#pragma once
#include <optional>

namespace keyblock {

/// Strength and stiffness of a joint.
struct JointProperties {
  double friction = 0.0;  ///< degrees
  double cohesion = 0.0;  ///< Pa; of a joint in place, lost when it slips or opens
  double tension = 0.0;   ///< Pa; tensile strength, likewise
  /// Normal stiffness, Pa/m. Not given: 20 E per metre (core of the default: stiff against the rock, no more).
  std::optional<double> normal_stiffness;
  /// Shear over normal stiffness.
  double stiffness_ratio = 0.4;
};

}  // namespace keyblock
