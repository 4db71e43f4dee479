#pragma once
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

/// The increments of the last steps, and what they say of the next: it changes as much as the last one did. Where no contact has changed
/// its state for a while they go on as a polynomial through more of them does. Velocities say less: contact springs that Δt does not
/// resolve turn the sign of theirs in every step.
class IncrementHistory {
 public:
  void forget() { known_ = quiet_ = 0; }

  /// Whether no contact has changed its state for long enough to say where increments go on.
  [[nodiscard]] bool is_smooth() const { return quiet_ >= 3; }

  /// Of a step of length dt, s; quiet: no contact changed its state in it, against what was expected. Steps of another length are
  /// forgotten.
  void add(std::span<const double> increment, double dt, bool quiet, ThreadTeam& team) {
    if (dt != dt_) forget();
    known_ = std::min(known_ + 1, most);
    quiet_ = quiet ? std::min(quiet_ + 1, most) : 0;
    dt_ = dt;
    std::rotate(increments_.begin(), increments_.end() - 1, increments_.end());
    increments_[0].resize(increment.size());
    team.for_range(increment.size(), coefficients_worth_threads, [&](std::size_t begin, std::size_t end) {
      std::copy(increment.begin() + static_cast<std::ptrdiff_t>(begin),
                increment.begin() + static_cast<std::ptrdiff_t>(end), &increments_[0][begin]);
    });
  }

  /// Of the next step, of length dt, into `increment`: zero where nothing is known.
  void extrapolate(double dt, std::span<double> increment, ThreadTeam& team) const {
    if (known_ == 0 || dt != dt_) return std::fill(increment.begin(), increment.end(), 0.0);
    // A change of state leaves no smooth curve through the increments before and after it.
    const int points = std::min(known_, std::max(2, quiet_));
    switch (points) {
      case 1:
        return combine<1>({1.0}, increment, team);
      case 2:
        return combine<2>({2.0, -1.0}, increment, team);
      case 3:
        return combine<3>({3.0, -3.0, 1.0}, increment, team);
      default:
        return combine<4>({4.0, -6.0, 4.0, -1.0}, increment, team);
    }
  }

 private:
  /// Σ weights_k increments_k
  template <std::size_t count>
  void combine(std::array<double, count> weights, std::span<double> sum, ThreadTeam& team) const {
    team.for_range(sum.size(), coefficients_worth_threads, [&](std::size_t begin, std::size_t end) {
      in_lanes(static_cast<int>(end - begin), [&](int first, int lanes) {
        const std::size_t i = begin + static_cast<std::size_t>(first);
        Lanes x = weights[0] * load_first(&increments_[0][i], lanes);
        for (std::size_t k = 1; k < count; ++k) x += weights[k] * load_first(&increments_[k][i], lanes);
        store_first(&sum[i], x, lanes);
      });
    });
  }

  /// Beyond, what is left of tolerances of the steps before, times the sum of the weights, is more than is gained.
  static constexpr int most = 4;
  int known_ = 0;  ///< increments
  int quiet_ = 0;  ///< steps in a row
  double dt_ = 0.0;
  std::array<std::vector<double>, most> increments_;  ///< the last one first
};

}  // namespace keyblock::dynamics
