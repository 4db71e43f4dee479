#pragma once
#include <cmath>

namespace keyblock::dynamics {

/// Root of the slope of a convex, piecewise quadratic function along a line, to 1 % of `start`, its slope at zero. slope(α) rises
/// piecewise linearly from it; prepare(α) is called before slopes up to an α > 1 are asked for. 1 when the slope at zero is not negative:
/// the minimum, to the last digit.
template <typename Prepare, typename Slope>
double line_search(double start, const Prepare& prepare, const Slope& slope) {
  const double target = 0.01 * std::abs(start);
  if (!(start < 0.0)) return 1.0;
  double low = 0.0, low_slope = start, high = 1.0;
  double high_slope = slope(high);
  while (high_slope < -target && high < 64.0) {
    low = high;
    low_slope = high_slope;
    high *= 2.0;
    prepare(high);
    high_slope = slope(high);
  }
  if (std::abs(high_slope) <= target) return high;
  double alpha = high;
  for (int iteration = 0; iteration < 60; ++iteration) {
    // Regula falsi, with bisection every third time so that the bracket always shrinks.
    alpha =
        iteration % 3 == 2 ? 0.5 * (low + high) : low - low_slope * (high - low) / (high_slope - low_slope);
    const double value = slope(alpha);
    if (std::abs(value) <= target) break;
    if (value < 0.0) {
      low = alpha;
      low_slope = value;
    } else {
      high = alpha;
      high_slope = value;
    }
  }
  return alpha;
}

}  // namespace keyblock::dynamics
