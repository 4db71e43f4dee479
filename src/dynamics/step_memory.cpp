// What contacts remember for the next step, and where their energy went.
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "dynamics/contact_lanes.h"
#include "dynamics/step.h"

namespace keyblock::dynamics {

namespace {

/// n·moved or t·moved of each row, moved: what fixed blocks are moved by.
Lanes moved_along(std::span<const StepProblem::Row> rows, bool tangent) {
  Lanes along{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    along[i] = dot(tangent ? rows[i].tangent() : rows[i].normal, rows[i].moved);
  return along;
}

}  // namespace

/// Of as many contacts as there are accounts, at most the number of lanes, the first being contact `first`.
void Stepper::remember_contacts(std::size_t first, bool is_static, std::span<ContactAccount> accounts) {
  const std::span<contact::Contact> contacts = std::span(contacts_).subspan(first, accounts.size());
  const std::span<const StepProblem::Row> rows = std::span(problem_.rows()).subspan(first, accounts.size());
  const SpringArray& springs = problem_.springs();
  const auto at_first = [&](const std::vector<double>& numbers) { return load(&numbers[first]); };
  const LawLanes law = laws_of(contacts);
  MemoryLanes memory = memories_of(contacts);
  Lanes moved_normal{}, moved_shear{};
  if (!prescribed_.empty()) {
    moved_normal = moved_along(rows, false);
    moved_shear = moved_along(rows, true);
  }
  const Lanes bound = at_first(springs.bound), y = at_first(springs.y), w = at_first(springs.w);
  const contact::SpringLanes s(
      contact::SpringLanes::Constants{.normal_stiffness = law.normal_stiffness,
                                      .shear_stiffness = law.shear_stiffness,
                                      .depth = law.depth,
                                      .shear = memory.shear,
                                      .bound = bound,
                                      .tensile = at_first(springs.floor) < 0.0},
      contact::SpringLanes::Shifted{at_first(springs.kn), at_first(springs.ks),
                                    at_first(springs.y0) + moved_normal, at_first(springs.w0) - moved_shear});
  const Lanes zero{}, normal = s.normal_force(y), shear = s.shear_force(w), penetration = s.penetration(y),
                      input = -(normal * moved_normal - shear * moved_shear), stored_before = memory.stored;
  const contact::SpringLanes::Balance balance = s.balance(y, w);
  const auto closed = s.closed(y), locked = s.locked(w);
  const Lanes pressure = where(normal > zero, normal, zero), change = pressure - memory.normal_force;
  memory.normal_force = memory.bounding_force = pressure;
  if (!is_static && model_.solver.contact == ContactMethod::penalty) {
    const Lanes ahead = pressure + where(closed & ~locked & (bound > zero), change, zero);
    memory.bounding_force = where(ahead > zero, ahead, zero);
  }
  memory.shear = where(closed, s.elastic_shear(w), zero);
  memory.stored = balance.stored;
  keep(memory, contacts);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const bool is_closed = closed[i] != 0;
    contacts[i].memory.state = !is_closed       ? contact::State::open
                               : locked[i] != 0 ? contact::State::locked
                                                : contact::State::sliding;
    forces_[first + i] = {normal[i], is_closed ? shear[i] : 0.0};
    accounts[i] = {{balance.stored[i], balance.friction[i], balance.damping[i], balance.numerical[i]},
                   stored_before[i],
                   input[i],
                   penetration[i],
                   is_closed};
  }
}

/// What is otherwise with an augmented Lagrangian.
void Stepper::remember_multiplier(std::size_t c, ContactAccount& account) {
  const StepProblem::Row& row = problem_.rows()[c];
  contact::Memory& memory = contacts_[c].memory;
  const contact::Spring s = problem_.spring(contacts_[c], c);
  const double y = problem_.springs().y[c], w = problem_.springs().w[c];
  const Vec2 r = open_close_.relative()[c];
  account.balance = s.rigid_balance(y, w, dot(row.normal, r), dot(row.tangent(), r));
  memory.stored = account.balance.stored;
  const double penetration = -(contacts_[c].gap + dot(row.normal, r));
  memory.offset = std::max(memory.offset, 0.0);
  account.penetration = 0.0;
  memory.multiplier = 0.0;
  if (account.closed) {
    account.penetration = penetration - memory.offset;
    memory.multiplier = s.normal_force(y) / contacts_[c].normal_stiffness;
    memory.shear = s.shear_force(w) / contacts_[c].shear_stiffness;
  }
  memory.drift = memory.state == contact::State::locked ? memory.drift + dot(row.tangent(), r) : 0.0;
}

/// Contact memory for the next step, and where the energy of contacts went.
void Stepper::remember(State& state, const Drive& drive, StepReport& report) {
  forces_.resize(contacts_.size());
  // What was stored in contacts that have ended, a vertex that left its edge, is lost.
  state.ledger.numerical += contact_energy_;
  contact_energy_ = 0.0;
  // Of the contacts, whose accounts are kept at a time: as a cache has room for, or worth the threads.
  const std::size_t piece = team_.size() == 1 ? 1 << 8 : 1 << 14;
  for (std::size_t first = 0; first < contacts_.size(); first += piece) {
    accounts_.resize(std::min(piece, contacts_.size() - first));
    team_.for_range((accounts_.size() + lane_count - 1) / lane_count, contacts_worth_threads / lane_count,
                    [&](std::size_t begin, std::size_t end) {
                      for (std::size_t group = begin; group < end; ++group) {
                        const std::size_t k = group * lane_count;
                        const std::size_t count = std::min<std::size_t>(lane_count, accounts_.size() - k);
                        const auto accounts = std::span(accounts_).subspan(k, count);
                        remember_contacts(first + k, drive.is_static, accounts);
                        if (model_.solver.contact == ContactMethod::penalty) continue;
                        for (std::size_t i = 0; i < count; ++i)
                          remember_multiplier(first + k + i, accounts[i]);
                      }
                    });
    for (const ContactAccount& account : accounts_) {
      account.enter(state.ledger);
      contact_energy_ += account.balance.stored;
      report.penetration = std::max(report.penetration, account.penetration);
      if (account.closed) ++report.closed_contacts;
    }
  }
  contact::keep_memory(contacts_, state.contacts, team_);
  report.contact_energy = contact_energy();
}

}  // namespace keyblock::dynamics
