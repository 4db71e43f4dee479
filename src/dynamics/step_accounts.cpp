#include "dynamics/step_accounts.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/known_size.h"
#include "dynamics/position_update.h"
#include "model/state_motion.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

/// What inertia loses.
double StepAccounts::inertia_loss(const Attempt& attempt, std::size_t b, double inertia) {
  double numerical = 0.0;
  const Drive& drive = attempt.drive;
  const Body& block = attempt.model.body(b);
  const double* d = &attempt.increment[block.first];
  const double* v = &attempt.state.velocity[block.first];
  with_known_size(block.size, [&](auto size) {
    // What keeps a static step from going on is no inertia: its work is kept by nobody.
    if (drive.is_static) {
      for (int k = 0; k < 2 * size; ++k) numerical += inertia * d[k] * d[k];
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
      for (int i = 0; i < count; ++i) numerical += lost[i];
    });
  });
  return numerical;
}

StepAccounts::BlockWork StepAccounts::work_of(const Attempt& attempt, std::size_t b, double inertia) {
  BlockWork work;
  const Drive& drive = attempt.drive;
  const Block& block = attempt.model.blocks[b];
  const double* d = &attempt.increment[block.first];
  work.numerical = inertia_loss(attempt, b, inertia);
  work.input = -block.body_force() * dot(drive.ground_acceleration, {d[0], d[1]});
  // Some rules balance forces at a moment within the step. There the force has a share of how it was at the start.
  const double of_start = 1.0 - drive.rule[b].end_share_of_work();
  if (of_start == 0.0) return work;
  const double earlier =
      -of_start * block.body_force() * dot(drive.ground_before - drive.ground_acceleration, {d[0], d[1]});
  work.input += earlier;
  work.numerical += earlier;
  return work;
}

void StepAccounts::account_for_loads(const Attempt& attempt, EnergyLedger& ledger) {
  const Drive& drive = attempt.drive;
  ledger.input += work_of_loads(attempt.model, drive.end_time, attempt.increment);
  for (std::size_t l = 0; l < attempt.model.loads.size(); ++l) {
    const GeneralizedLoad& load = attempt.model.loads[l];
    const double of_start = 1.0 - drive.end_share_of_work(load.block);
    if (!attempt.model.moves(at(load.block)) || of_start == 0.0) continue;
    const double change =
        attempt.model.load_factor(l, drive.start_time()) - attempt.model.load_factor(l, drive.end_time);
    const std::size_t first = attempt.model.blocks[at(load.block)].first;
    double earlier = 0.0;
    for (std::size_t k = 0; k < load.force.size(); ++k)
      earlier += of_start * change * load.force[k] * attempt.increment[first + k];
    ledger.input += earlier;
    ledger.numerical += earlier;
  }
}

void StepAccounts::account_for_blocks(const Attempt& attempt, std::span<const double> spin, State& state) {
  const Model& model = attempt.model;
  const BlockTerms& terms = attempt.problem.terms();
  EnergyLedger& ledger = state.ledger;
  const BlockTerms::ElasticLoss elastic = terms.elastic_loss(state, attempt.increment, spin);
  ledger.numerical += elastic.numerical;
  ledger.damping += elastic.damping;
  work_.assign(model.blocks.size(), {});
  for_moving_blocks(model, attempt.team,
                    [&](std::size_t b) { work_[b] = work_of(attempt, b, terms.inertia(b)); });
  for (const BlockWork& work : work_) {
    ledger.numerical += work.numerical;
    ledger.input += work.input;
  }
  for (std::size_t b = model.blocks.size(); b < model.bodies(); ++b)
    ledger.numerical += inertia_loss(attempt, b, terms.inertia(b));
  account_for_loads(attempt, ledger);
}

CouplingTotals account_for_couplings(const Attempt& attempt, std::span<const double> spin, State& state) {
  state.support_energy = 0.0;
  CouplingTotals totals;
  const std::span<const StepProblem::Part> parts = attempt.problem.parts();
  for (std::size_t k = 0; k < parts.size(); ++k) {
    // Contacts are the first part, and have their memory elsewhere: State::contacts.
    const std::span<double> memory = k == 0 ? std::span<double>() : state.couplings[k - 1];
    totals += parts[k].coupling->account(attempt, spin, parts[k].first, memory, state);
  }
  return totals;
}

}  // namespace keyblock::dynamics
