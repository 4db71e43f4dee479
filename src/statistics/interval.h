#pragma once
#include <limits>

namespace keyblock::statistics {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A confidence interval. Not a number where the sample is too small to tell; infinite where there is no bound.
struct Interval {
  double low = not_a_number, high = not_a_number;
};

/// What is estimated, with its confidence interval.
struct Estimate {
  double value = not_a_number;
  double low = not_a_number, high = not_a_number;
};

}  // namespace keyblock::statistics
