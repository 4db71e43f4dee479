#pragma once
#include <cstddef>

#include "core/lanes.h"

namespace keyblock::dynamics {

/// Row k of w × r, of the relative part r of a block's coefficients, which a turn by w rad changes them by.
inline double turn_of(double w, const double* position, std::size_t k) {
  return k < 2 ? 0.0 : k % 2 == 0 ? -w * position[k + 1] : w * position[k - 1];
}
/// The same of `count` rows, at most as many as there are lanes, from an even k on.
inline Lanes turn_of(double w, const double* position, int k, int count) {
  const Lanes turns =
      lanes_from(-w, w, -w, w, -w, w, -w, w) * swap_neighbours(load_first(position + k, count));
  return k == 0 ? where(first_lanes(2), Lanes{}, turns) : turns;
}

}  // namespace keyblock::dynamics
