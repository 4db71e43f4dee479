#pragma once
#include "model/model.h"
#include "model/state.h"
#include "record/record.h"

namespace keyblock::simulation {

/// J per thickness, that the system has stored: kinetic + strain + gravity + springs of contacts and supports.
double stored_energy(const dynamics::Model& model, const dynamics::State& state);

/// Where the energy of a run is and where it went. All potentials count from the start of the run, when `initial` was stored, J per
/// thickness.
record::Energy energy_audit(const dynamics::Model& model, const dynamics::State& state, double initial);

/// Looks at what the time integration has made until now.
void watch_made(const dynamics::Model& model, const record::Energy& energy, double time,
                record::MadeEnergy& made);

}  // namespace keyblock::simulation
