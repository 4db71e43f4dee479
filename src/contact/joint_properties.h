#pragma once
#include <optional>

namespace keyblock::contact {

/// Strength and stiffness of a joint.
struct JointProperties {
  double friction = 0.0;  ///< degrees
  double cohesion = 0.0;  ///< Pa; of a joint in place, lost when it slips or opens
  double tension = 0.0;   ///< Pa; tensile strength, likewise
  /// What is left of the strength of a joint after a slip. Not given: a plain joint (contact::JointLaw).
  struct Residual {
    double friction = 0.0;  ///< degrees, no more than that of the peak
    double cohesion = 0.0;  ///< Pa, no more than that of the peak; of a joint that has not opened
    double slip = 0.0;      ///< m, over which strength falls; 0: at once
  };
  std::optional<Residual> residual;
  /// Normal stiffness, Pa/m. Not given: `[solver] penalty` times E per metre, by default 20 E: stiff against the rock, no more.
  std::optional<double> normal_stiffness;
  /// Shear over normal stiffness.
  double stiffness_ratio = 0.4;
};

}  // namespace keyblock::contact
