#include "simulation/energy_audit.h"

#include <algorithm>
#include <cmath>

#include "dynamics/energy.h"

namespace keyblock::simulation {

namespace {

/// J per thickness, of what nobody sees: it lifts all blocks by a billionth of their size, and strains them by a billionth. Terms that stay
/// below it are rounding, and what a step may leave over (SolverOptions::tolerance).
double unseen_energy(const dynamics::Model& model) {
  constexpr double unseen = 1e-9;
  const double g = norm(model.gravity);
  double sum = 0.0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const dynamics::Block& block = model.blocks[b];
    if (!model.moves(b)) continue;
    sum += unseen * block.mass() * g * std::sqrt(block.area) +
           0.5 * unseen * unseen * block.material.young * block.area;
  }
  return sum;
}

double largest_but_numerical(const dynamics::Model& model, const record::Energy& e) {
  double largest = unseen_energy(model);
  for (const double term :
       {e.kinetic, e.strain, e.gravity, e.contact, e.friction, e.damping, e.radiated, e.input, e.water})
    largest = std::max(largest, std::abs(term));
  return largest;
}

}  // namespace

double stored_energy(const dynamics::Model& model, const dynamics::State& state) {
  return dynamics::kinetic_energy(model, state) + dynamics::strain_energy(model, state) +
         dynamics::gravity_energy(model, state) + dynamics::spring_energy(state);
}

record::Energy energy_audit(const dynamics::Model& model, const dynamics::State& state, double initial) {
  const dynamics::EnergyLedger& ledger = state.ledger;
  record::Energy e;
  e.kinetic = dynamics::kinetic_energy(model, state);
  e.strain = dynamics::strain_energy(model, state);
  e.contact = dynamics::spring_energy(state);
  e.friction = ledger.friction;
  e.damping = ledger.damping;
  e.numerical = ledger.numerical;
  e.radiated = ledger.radiated;
  e.input = ledger.input;
  e.water = ledger.water;
  e.gravity = dynamics::gravity_energy(model, state) - initial;
  const double residual = e.kinetic + e.strain + e.gravity + e.contact + e.friction + e.damping + e.radiated +
                          e.numerical - e.input - e.water;
  const double largest = std::max(largest_but_numerical(model, e), std::abs(e.numerical));
  e.residual_ratio = residual == 0.0 ? 0.0 : std::abs(residual) / largest;  // no number where a term is none
  return e;
}

void watch_made(const dynamics::Model& model, const record::Energy& energy, double time,
                record::MadeEnergy& made) {
  made.highest = std::max(made.highest, energy.numerical);
  made.largest = std::max(made.largest, largest_but_numerical(model, energy));
  const double now = made.highest - energy.numerical, ratio = now / made.largest;
  made.most = std::max(made.most, now);
  if (!(ratio > made.ratio)) return;
  made.ratio = ratio;
  made.time = time;
}

}  // namespace keyblock::simulation
