#pragma once
#include <vector>

#include "coupling/rock_column.h"

namespace keyblock::dynamics {

/// A symmetric matrix with one diagonal beside the main one, and the right side.
struct RockColumn::Tridiagonal {
  std::vector<double> diagonal, beside, right;
  explicit Tridiagonal(std::size_t n) : diagonal(n, 0.0), beside(n, 0.0), right(n, 0.0) {}

  /// The solution, in the place of the right side.
  void solve() {
    const std::size_t n = right.size();
    for (std::size_t k = 1; k < n; ++k) {
      const double share = beside[k - 1] / diagonal[k - 1];
      diagonal[k] -= share * beside[k - 1];
      right[k] -= share * right[k - 1];
    }
    for (std::size_t k = n; k-- > 0;)
      right[k] = (right[k] - (k + 1 < n ? beside[k] * right[k + 1] : 0.0)) / diagonal[k];
  }
};

}  // namespace keyblock::dynamics
