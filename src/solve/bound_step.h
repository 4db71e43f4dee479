#pragma once
#include <algorithm>

#include "solve/step_numbers.h"

namespace keyblock::dynamics {

/// The last step of a friction bound towards the normal force of its contact, N per thickness.
struct BoundStep {
  double missing = 0.0;  ///< by how much it was wrong
  double taken = 0.0;    ///< the change that it got for that

  /// Share of its way that the last step shows to be right (secant), where it is wrong by so much now. Two contacts of a wedge that go the
  /// whole way may hand a bound to and fro for ever.
  [[nodiscard]] double share(double missing_now) const {
    const double gained = missing - missing_now;
    return taken * gained > 0.0 ? std::clamp(taken / gained, step_numbers::least_bound_share, 1.0) : 1.0;
  }
};

}  // namespace keyblock::dynamics
