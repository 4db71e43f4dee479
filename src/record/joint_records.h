#pragma once
#include <cstdint>
#include <string>

#include "cutting/block_system.h"

namespace keyblock::record {

/// Joints of one strength: of a set or trace map, or one trace of it where strengths differ from trace to trace. Peak and residual strength as given,
/// over the strength_factor of the set; no stage and no program has changed it yet.
struct JointRecord {
  cutting::EdgeLabel label;  ///< its trace: −1 for all of the set or map
  double length = 0.0;       ///< m, that bounds blocks
  double friction = 0.0;     ///< °
  double cohesion = 0.0;     ///< Pa
  double tension = 0.0;      ///< Pa
  /// Of joints that weaken; else not a number.
  double residual_friction = 0.0, residual_cohesion = 0.0, weakening_slip = 0.0;
};

/// A number of JointRecord, described once: result.h5, CSV and Python have their columns from here.
struct JointField {
  const char* name;
  const char* unit;
  const char* meaning;
  double JointRecord::*number;
};

inline constexpr JointField joint_fields[] = {
    {"length", "m", "of joint that bounds blocks", &JointRecord::length},
    {"friction", "degrees", "friction angle of the peak", &JointRecord::friction},
    {"cohesion", "Pa", "cohesion of the peak", &JointRecord::cohesion},
    {"tension", "Pa", "tensile strength", &JointRecord::tension},
    {"residual_friction", "degrees", "friction angle that is left; none: the joint does not weaken",
     &JointRecord::residual_friction},
    {"residual_cohesion", "Pa", "cohesion that is left; none: the joint does not weaken",
     &JointRecord::residual_cohesion},
    {"weakening_slip", "m", "slip over which strength falls; none: the joint does not weaken",
     &JointRecord::weakening_slip}};

/// A strength that is drawn, or that a trace map has for each trace, over the traces that bound blocks; each of these counts once, whatever its length.
/// Before any factor.
struct DrawnStrength {
  std::string joint;  ///< name of the set or map
  std::string key;    ///< "friction"
  std::string unit;   ///< "°" or "Pa"
  std::string per;    ///< "joint", "line", "realization"; "map": the map has them
  int traces = 0;     ///< that bound blocks
  double mean = 0.0;
  double std = 0.0;  ///< of a sample; 0 of one
  double least = 0.0, largest = 0.0;
  int capped = 0;  ///< residual strengths above the peak of their trace, which is used in their place

  /// `bedding.friction`
  [[nodiscard]] std::string name() const { return joint + "." + key; }
};

/// Calls visit(name, value) for all that files have of a strength that was drawn.
template <class Strength, class Visit>
void visit_strength(Strength& drawn, const Visit& visit) {
  visit("joint", drawn.joint);
  visit("key", drawn.key);
  visit("unit", drawn.unit);
  visit("per", drawn.per);
  visit("traces", drawn.traces);
  visit("mean", drawn.mean);
  visit("std", drawn.std);
  visit("least", drawn.least);
  visit("largest", drawn.largest);
  visit("above_peak", drawn.capped);
}

}  // namespace keyblock::record
