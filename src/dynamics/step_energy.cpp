// Where the energy of a step goes.
#include <cmath>

#include "core/index.h"
#include "core/known_size.h"
#include "dynamics/step.h"

namespace keyblock::dynamics {

double Stepper::support_energy(const State& state, double time) const {
  double sum = 0.0;
  for (const GroundSpring& spring : model_.springs) {
    if (!model_.moves(at(spring.block))) continue;
    const std::size_t first = model_.blocks[at(spring.block)].first + at(spring.axis);
    double coordinate = 0.0;
    for (std::size_t k = 0; k < spring.phi.size(); ++k)
      coordinate += spring.phi[k] * state.position[first + 2 * k];
    const double stretch = coordinate - spring.target(time);
    sum += 0.5 * spring.stiffness * stretch * stretch;
  }
  return sum;
}

void Stepper::sum_stored_energy(State& state) const {
  state.contact_energy = 0.0;
  for (const contact::Memory& memory : state.contacts.memory) state.contact_energy += memory.stored;
  state.support_energy = support_energy(state, state.time);
}

void Stepper::measure_stored_energy(State& state) {
  detect_at_rest(state);
  for (contact::Contact& c : contacts_) {
    if (model_.solver.contact == ContactMethod::augmented_lagrangian) break;  // multipliers store nothing
    const bool pulls = c.fused || (c.memory.bonded && c.tension > 0.0);
    c.memory.stored = contact::Spring({.normal_stiffness = c.normal_stiffness,
                                       .shear_stiffness = c.shear_stiffness,
                                       .depth = c.depth,
                                       .shear = c.memory.shear,
                                       .tensile = pulls})
                          .stored_at_start();
  }
  contact::keep_memory(contacts_, state.contacts, team_);
  sum_stored_energy(state);
}

/// What turning did to springs that the step was linear in, once blocks are where they come to be.
void Stepper::account_for_turns(State& state, const Drive& drive) {
  double gained = keep_turned_shear(state);
  state.contact_energy += gained;
  if (!model_.springs.empty()) {
    const double now = support_energy(state, drive.end_time);
    gained += now - state.support_energy;
    state.support_energy = now;
  }
  state.ledger.numerical -= gained;
}

void Stepper::account(State& state, const Drive& drive) {
  const Profile::Scope scope(profile_, Phase::energy);
  EnergyLedger& ledger = state.ledger;
  const StepProblem::ElasticLoss elastic = problem_.elastic_loss(state, increment_, spin_);
  ledger.numerical += elastic.numerical;
  ledger.damping += elastic.damping;
  block_work_.assign(model_.blocks.size(), {});
  for_blocks([&](std::size_t b) {
    BlockWork& work = block_work_[b];
    const Block& block = model_.blocks[b];
    const double* d = &increment_[block.first];
    const double* v = &state.velocity[block.first];
    with_known_size(block.size, [&](auto size) {
      if (drive.is_static) {
        for (int k = 0; k < 2 * size; ++k) work.numerical += problem_.inertia(b) * d[k] * d[k];
        return;
      }
      // Work of the forces at the end of the step, less what became kinetic energy.
      const double density = block.material.density;
      const Integrator rule = rule_[b];
      in_lanes(2 * size, [&](int k, int count) {
        const Lanes moved = load_first(d + k, count), before = load_first(v + k, count);
        const Motion end = rule.end(motion(state, block.first + at(k), count), moved, drive.step);
        const Lanes lost =
            density * (end.force * moved - 0.5 * (end.velocity * end.velocity - before * before));
        for (int i = 0; i < count; ++i) work.numerical += lost[i];
      });
    });
    work.input = -block.body_force() * dot(drive.ground_acceleration, {d[0], d[1]});
  });
  for (const BlockWork& work : block_work_) {
    ledger.numerical += work.numerical;
    ledger.input += work.input;
  }
  for (const GeneralizedLoad& load : model_.loads) {
    if (!model_.moves(at(load.block))) continue;
    const double f = load.factor.empty() ? 1.0 : load.factor(drive.end_time);
    for (std::size_t k = 0; k < load.force.size(); ++k)
      ledger.input += f * load.force[k] * increment_[model_.blocks[at(load.block)].first + k];
  }
  state.support_energy = 0.0;
  for (const GroundSpring& spring : model_.springs) {
    if (!model_.moves(at(spring.block))) continue;
    const std::size_t first = model_.blocks[at(spring.block)].first + at(spring.axis);
    double coordinate = 0.0, moved = 0.0;
    for (std::size_t k = 0; k < spring.phi.size(); ++k) {
      coordinate += spring.phi[k] * state.position[first + 2 * k];
      moved += spring.phi[k] * increment_[first + 2 * k];
    }
    const double before = spring.target(drive.is_static ? drive.end_time : drive.end_time - drive.step),
                 end = spring.target(drive.end_time);
    const double stretch = coordinate + moved - end, change = moved - (end - before);
    state.support_energy += 0.5 * spring.stiffness * stretch * stretch;
    ledger.input -= spring.stiffness * stretch * (end - before);
    // elastic_loss has taken ½ k moved² for a ground that stands still.
    ledger.numerical += 0.5 * spring.stiffness * (change * change - moved * moved);
  }
}

void Stepper::ContactAccounts::add(const ContactAccounts& other) {
  balance.stored += other.balance.stored;
  balance.friction += other.balance.friction;
  balance.damping += other.balance.damping;
  balance.numerical += other.balance.numerical;
  stored_before += other.stored_before;
  input += other.input;
  turned += other.turned;
  penetration = largest(penetration, other.penetration);
  closed += other.closed;
}

void Stepper::ContactAccounts::leave_out_beyond(std::size_t count) {
  if (count >= lane_count) return;
  for (Lanes* lanes : {&balance.stored, &balance.friction, &balance.damping, &balance.numerical,
                       &stored_before, &input, &turned, &penetration, &closed})
    *lanes = where(first_lanes(count), *lanes, Lanes{});
}

void Stepper::ContactAccounts::enter(EnergyLedger& ledger) const {
  ledger.friction += sum(balance.friction);
  ledger.input += sum(input);
  ledger.damping += sum(balance.damping);
  ledger.numerical += sum(balance.numerical) + sum(turned) - sum(stored_before);
}

double Stepper::kinetic_energy(const State& state) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    const Block& block = model_.blocks[b];
    double squared = 0.0;
    for (std::size_t k = block.first; k < block.first + 2 * at(block.size); ++k)
      squared += state.velocity[k] * state.velocity[k];
    sum += 0.5 * block.material.density * squared;
  }
  return sum;
}

double Stepper::strain_energy(const State& state) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (model_.moves(b)) sum += model_.blocks[b].elasticity.energy(&state.position[model_.blocks[b].first]);
  }
  return sum;
}

double Stepper::gravity_energy(const State& state) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    const Block& block = model_.blocks[b];
    const Vec2 now{state.position[block.first], state.position[block.first + 1]};
    sum -= block.body_force() * dot(model_.gravity, now - std::sqrt(block.area) * block.centroid);
  }
  return sum;
}

}  // namespace keyblock::dynamics
