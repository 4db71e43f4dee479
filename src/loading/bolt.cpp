#include "loading/bolt.h"

#include <algorithm>
#include <cmath>

namespace keyblock::loading {

double BoltSide::capacity() const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  if (has_plate_) return infinite;
  return is_grouted() ? strength() * grouted_ : 0.0;
}

double BoltSide::hold(double x) const {
  const double alpha = std::sqrt(bolt_->grout_stiffness / bolt_->bar()), t = std::tanh(alpha * x);
  return has_plate_ ? 1.0 / t : t;
}

double BoltSide::grout_displacement(double force) const {
  const double stiffness = std::sqrt(bolt_->grout_stiffness * bolt_->bar()),  // EA α
      elastic = stiffness * hold(grouted_), slip = strength() / bolt_->grout_stiffness;
  if (force <= elastic * slip) return force / elastic;
  const auto still_elastic = [&](double slipping) { return stiffness * slip * hold(grouted_ - slipping); };
  double low = 0.0, high = grouted_;
  for (int k = 0; k < 200 && low < high; ++k) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high) break;
    (still_elastic(middle) + strength() * middle < force ? low : high) = middle;
  }
  // The force is that at the joint, whatever the rounding of l.
  return slip + ((force - strength() * low) * low + 0.5 * strength() * low * low) / bolt_->bar();
}

double BoltSide::displacement(double force) const {
  const double in_grout =
      is_grouted() ? grout_displacement(force) : 0.0;  // without grout the plate holds at the end of f
  return in_grout + force * free_ / bolt_->bar();
}

BoltAtJoint bolt_at_joint(const Bolt& bolt, const BoltSide& head, const BoltSide& toe) {
  BoltAtJoint joint;
  joint.capacity = std::min(
      {bolt.yield.value_or(std::numeric_limits<double>::infinity()), head.capacity(), toe.capacity()});
  if (joint.capacity == 0.0) return joint;
  // What never yields nor slips is as stiff at any force.
  const double force = std::isfinite(joint.capacity) ? joint.capacity : 1.0;
  joint.stiffness = force / (head.displacement(force) + toe.displacement(force));
  return joint;
}

}  // namespace keyblock::loading
