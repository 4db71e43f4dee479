#pragma once
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace keyblock::dynamics {

/// The increments of the last two steps, and what they say of the next: it changes as much as the last one did. Velocities say less:
/// contact springs that Δt does not resolve turn the sign of theirs in every step.
class IncrementHistory {
 public:
  void forget() { known_ = 0; }

  /// Of a step of length dt, s. Steps of another length are forgotten.
  void add(std::span<const double> increment, double dt) {
    known_ = dt == dt_ ? std::min(known_ + 1, 2) : 1;
    dt_ = dt;
    std::swap(last_, before_);
    last_.assign(increment.begin(), increment.end());
  }

  /// Of the next step, of length dt, into `increment`: zero where nothing is known.
  void extrapolate(double dt, std::span<double> increment) const {
    if (known_ == 0 || dt != dt_) {
      std::fill(increment.begin(), increment.end(), 0.0);
    } else if (known_ == 1) {
      std::copy(last_.begin(), last_.end(), increment.begin());
    } else {
      for (std::size_t k = 0; k < increment.size(); ++k) increment[k] = 2.0 * last_[k] - before_[k];
    }
  }

 private:
  int known_ = 0;  ///< of the two
  double dt_ = 0.0;
  std::vector<double> last_, before_;
};

}  // namespace keyblock::dynamics
