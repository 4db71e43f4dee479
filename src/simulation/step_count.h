#pragma once
#include <cmath>

namespace keyblock::simulation {

/// Steps of a stage of a duration, s: the nearest whole number, as a double since nothing bounds it here.
inline double step_count(double duration, double time_step) {
  return std::round(duration / time_step);
}

}  // namespace keyblock::simulation
