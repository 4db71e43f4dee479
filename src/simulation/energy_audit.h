#pragma once
#include "model/model.h"
#include "model/state.h"
#include "simulation/record.h"

namespace keyblock::simulation {

/// J per thickness, that the system has stored: kinetic + strain + gravity + springs of contacts and supports.
double stored_energy(const dynamics::Model& model, const dynamics::State& state);

/// Where the energy of a run is and where it went. All potentials count from the start of the run, when `initial` was stored, J per
/// thickness.
Energy energy_audit(const dynamics::Model& model, const dynamics::State& state, double initial);

/// Energy that the time integration has made rather than dissipated, over the largest of the other terms; 0: it has made none.
double made_ratio(const dynamics::Model& model, const Energy& energy);

}  // namespace keyblock::simulation
