#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace keyblock::dynamics {

/// The increments of the last steps, and what they say of the next: it changes as much as the last one did. Where no contact has changed
/// its state for a while they go on as a polynomial through more of them does. Velocities say less: contact springs that Δt does not
/// resolve turn the sign of theirs in every step.
class IncrementHistory {
 public:
  void forget() { known_ = quiet_ = 0; }

  /// Of a step of length dt, s; quiet: no contact changed its state in it, against what was expected. Steps of another length are
  /// forgotten.
  void add(std::span<const double> increment, double dt, bool quiet) {
    if (dt != dt_) forget();
    known_ = std::min(known_ + 1, most);
    quiet_ = quiet ? std::min(quiet_ + 1, most) : 0;
    dt_ = dt;
    std::rotate(increments_.begin(), increments_.end() - 1, increments_.end());
    increments_[0].assign(increment.begin(), increment.end());
  }

  /// Of the next step, of length dt, into `increment`: zero where nothing is known.
  void extrapolate(double dt, std::span<double> increment) const {
    std::fill(increment.begin(), increment.end(), 0.0);
    if (dt != dt_) return;
    // A change of state leaves no smooth curve through the increments before and after it.
    const int points = std::min(known_, std::max(2, quiet_));
    double weight = -1.0;  // (−1)^(k + 1) (points choose k)
    for (int k = 1; k <= points; ++k) {
      weight *= -static_cast<double>(points + 1 - k) / k;
      const std::vector<double>& before = increments_[static_cast<std::size_t>(k - 1)];
      for (std::size_t i = 0; i < increment.size(); ++i) increment[i] += weight * before[i];
    }
  }

 private:
  /// Beyond, what is left of tolerances of the steps before, times the sum of the weights, is more than is gained.
  static constexpr int most = 4;
  int known_ = 0;  ///< increments
  int quiet_ = 0;  ///< steps in a row
  double dt_ = 0.0;
  std::array<std::vector<double>, most> increments_;  ///< the last one first
};

}  // namespace keyblock::dynamics
