#include "dynamics/step_accounts.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/known_size.h"
#include "dynamics/state_motion.h"
#include "dynamics/worth_threads.h"

namespace keyblock::dynamics {

StepAccounts::BlockWork StepAccounts::work_of(const Attempt& attempt, std::size_t b, double inertia) {
  BlockWork work;
  const Drive& drive = attempt.drive;
  const Block& block = attempt.model.blocks[b];
  const double* d = &attempt.increment[block.first];
  const double* v = &attempt.state.velocity[block.first];
  with_known_size(block.size, [&](auto size) {
    if (drive.is_static) {
      for (int k = 0; k < 2 * size; ++k) work.numerical += inertia * d[k] * d[k];
      return;
    }
    // Work of the forces at the end of the step, less what became kinetic energy.
    const double density = block.material.density;
    const Integrator rule = drive.rule[b];
    in_lanes(2 * size, [&](int k, int count) {
      const Lanes moved = load_first(d + k, count), before = load_first(v + k, count);
      const Motion end = rule.end(motion_of(attempt.state, block.first + at(k), count), moved, drive.step);
      const Lanes lost =
          density * (end.force * moved - 0.5 * (end.velocity * end.velocity - before * before));
      for (int i = 0; i < count; ++i) work.numerical += lost[i];
    });
  });
  work.input = -block.body_force() * dot(drive.ground_acceleration, {d[0], d[1]});
  return work;
}

void StepAccounts::account_for_blocks(const Attempt& attempt, std::span<const double> spin,
                                      StepProblem& problem, State& state) {
  const Model& model = attempt.model;
  EnergyLedger& ledger = state.ledger;
  const BlockTerms::ElasticLoss elastic = problem.terms().elastic_loss(state, attempt.increment, spin);
  ledger.numerical += elastic.numerical;
  ledger.damping += elastic.damping;
  work_.assign(model.blocks.size(), {});
  for_moving_blocks(model, attempt.team,
                    [&](std::size_t b) { work_[b] = work_of(attempt, b, problem.terms().inertia(b)); });
  for (const BlockWork& work : work_) {
    ledger.numerical += work.numerical;
    ledger.input += work.input;
  }
  for (const GeneralizedLoad& load : model.loads) {
    if (!model.moves(at(load.block))) continue;
    const double f = load.factor.empty() ? 1.0 : load.factor(attempt.drive.end_time);
    for (std::size_t k = 0; k < load.force.size(); ++k)
      ledger.input += f * load.force[k] * attempt.increment[model.blocks[at(load.block)].first + k];
  }
  account_for_supports(attempt, state);
}

void StepAccounts::account_for_supports(const Attempt& attempt, State& state) {
  const Model& model = attempt.model;
  const Drive& drive = attempt.drive;
  state.support_energy = 0.0;
  for (const GroundSpring& spring : model.springs) {
    if (!model.moves(at(spring.block))) continue;
    const std::size_t first = model.blocks[at(spring.block)].first + at(spring.axis);
    double coordinate = 0.0, moved = 0.0;
    for (std::size_t k = 0; k < spring.phi.size(); ++k) {
      coordinate += spring.phi[k] * state.position[first + 2 * k];
      moved += spring.phi[k] * attempt.increment[first + 2 * k];
    }
    const double before = spring.target(drive.is_static ? drive.end_time : drive.end_time - drive.step),
                 end = spring.target(drive.end_time);
    const double stretch = coordinate + moved - end, change = moved - (end - before);
    state.support_energy += 0.5 * spring.stiffness * stretch * stretch;
    state.ledger.input -= spring.stiffness * stretch * (end - before);
    // elastic_loss has taken ½ k moved² for a ground that stands still.
    state.ledger.numerical += 0.5 * spring.stiffness * (change * change - moved * moved);
  }
}

ContactTotals StepAccounts::remember_contacts(const Attempt& attempt, State& state) {
  const std::size_t contacts = attempt.contacts.size();
  // What was stored in contacts that have ended, a vertex that left its edge, is lost.
  state.ledger.numerical += state.contact_energy;
  state.contacts.make_room(contacts);
  // Piece by piece, which are the same for any number of threads.
  constexpr std::size_t size = 64 * lane_count;
  pieces_.assign((contacts + size - 1) / size, {});
  attempt.team.for_range(
      pieces_.size(), contacts_worth_threads / size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
          pieces_[p] = remember_piece(attempt, p * size, std::min(contacts, (p + 1) * size), state.contacts);
      });
  ContactAccounts total;
  for (const ContactAccounts& accounts : pieces_) total.add(accounts);
  total.enter(state.ledger);
  state.contact_energy = sum(total.balance.stored);
  ContactTotals totals;
  for (std::size_t i = 0; i < lane_count; ++i)
    totals.penetration = std::max(totals.penetration, total.penetration[i]);
  totals.closed = static_cast<int>(sum(total.closed));
  return totals;
}

StepAccounts::ContactAccounts StepAccounts::remember_piece(const Attempt& attempt, std::size_t first,
                                                           std::size_t last, contact::CandidateList& list) {
  ContactAccounts sum;
  for (std::size_t c = first; c < last; c += lane_count) {
    const std::size_t count = std::min<std::size_t>(lane_count, last - c);
    const std::span<contact::Memory> remembered = std::span(list.memory).subspan(c, count);
    ContactAccounts accounts = remember_some(attempt, c, count, remembered);
    for (std::size_t i = 0; i < count; ++i) {
      if (attempt.model.solver.contact != ContactMethod::penalty)
        remember_multiplier(attempt, c + i, i, remembered[i], accounts);
      list.track(c + i, attempt.contacts[c + i].candidate);
    }
    sum.add(accounts);
  }
  return sum;
}

}  // namespace keyblock::dynamics
