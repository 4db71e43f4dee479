#pragma once
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

// J per thickness, of the blocks that move, in a state.

/// ½ Σ ρ v².
double kinetic_energy(const Model& model, const State& state);
/// Of the elastic strain of blocks.
double strain_energy(const Model& model, const State& state);
/// Against the positions before the run.
double gravity_energy(const Model& model, const State& state);
/// Of the couplings except contacts; what is prescribed to them is that of this time, s.
double support_energy(const Model& model, const State& state, double time);
/// In the springs of contacts and of other couplings, as the last step summed it.
inline double spring_energy(const State& state) {
  return state.contact_energy + state.support_energy;
}

}  // namespace keyblock::dynamics
