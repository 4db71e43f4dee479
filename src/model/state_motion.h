#pragma once
#include <cstddef>

#include "model/integrator.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// The motion of `count` coefficients from `first` on, as a rule of time integration reads it.
inline Motion motion_of(const State& state, std::size_t first, int count) {
  if (state.acceleration.empty()) return {.velocity = load_first(&state.velocity[first], count)};
  return {load_first(&state.velocity[first], count), load_first(&state.acceleration[first], count),
          load_first(&state.force[first], count)};
}

}  // namespace keyblock::dynamics
