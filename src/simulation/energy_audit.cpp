#include "simulation/energy_audit.h"

#include <algorithm>
#include <cmath>

#include "dynamics/energy.h"

namespace keyblock::simulation {

double stored_energy(const dynamics::Model& model, const dynamics::State& state) {
  return dynamics::kinetic_energy(model, state) + dynamics::strain_energy(model, state) +
         dynamics::gravity_energy(model, state) + dynamics::spring_energy(state);
}

Energy energy_audit(const dynamics::Model& model, const dynamics::State& state, double initial) {
  const dynamics::EnergyLedger& ledger = state.ledger;
  Energy e;
  e.kinetic = dynamics::kinetic_energy(model, state);
  e.strain = dynamics::strain_energy(model, state);
  e.contact = dynamics::spring_energy(state);
  e.friction = ledger.friction;
  e.damping = ledger.damping;
  e.numerical = ledger.numerical;
  e.radiated = ledger.radiated;
  e.input = ledger.input;
  e.gravity = dynamics::gravity_energy(model, state) - initial;
  const double residual = e.kinetic + e.strain + e.gravity + e.contact + e.friction + e.damping + e.radiated +
                          e.numerical - e.input;
  double largest = 0.0;
  for (const double term :
       {e.kinetic, e.strain, e.gravity, e.contact, e.friction, e.damping, e.radiated, e.numerical, e.input}) {
    largest = std::max(largest, std::abs(term));
  }
  e.residual_ratio = residual == 0.0 ? 0.0 : std::abs(residual) / largest;  // no number where a term is none
  return e;
}

}  // namespace keyblock::simulation
