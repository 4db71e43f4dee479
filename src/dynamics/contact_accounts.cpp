// What contacts remember for the next step, and where their energy went.
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "dynamics/step_accounts.h"

namespace keyblock::dynamics {

namespace {

/// n·moved or t·moved of each row, moved: the known part of its r.
Lanes moved_along(std::span<const StepProblem::Row> rows, bool tangent) {
  Lanes along{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    along[i] = dot(tangent ? rows[i].tangent() : rows[i].normal, rows[i].moved);
  return along;
}

}  // namespace

void StepAccounts::ContactAccounts::add(const ContactAccounts& other) {
  balance.stored += other.balance.stored;
  balance.friction += other.balance.friction;
  balance.damping += other.balance.damping;
  balance.numerical += other.balance.numerical;
  stored_before += other.stored_before;
  input += other.input;
  rotation += other.rotation;
  penetration = largest(penetration, other.penetration);
  closed += other.closed;
}

void StepAccounts::ContactAccounts::leave_out_beyond(std::size_t count) {
  if (count >= lane_count) return;
  for (Lanes* lanes : {&balance.stored, &balance.friction, &balance.damping, &balance.numerical,
                       &stored_before, &input, &rotation, &penetration, &closed})
    *lanes = where(first_lanes(count), *lanes, Lanes{});
}

void StepAccounts::ContactAccounts::enter(EnergyLedger& ledger) const {
  ledger.friction += sum(balance.friction);
  ledger.input += sum(input);
  ledger.damping += sum(balance.damping);
  ledger.numerical += sum(balance.numerical) + sum(rotation) - sum(stored_before);
}

/// Of `count` contacts, at most as many as there are lanes, the first being contact `first`.
StepAccounts::ContactAccounts StepAccounts::remember_some(const Attempt& attempt, std::size_t first,
                                                          std::size_t count,
                                                          std::span<contact::Memory> remembered) {
  const Drive& drive = attempt.drive;
  const std::span<const contact::Contact> contacts = attempt.contacts.subspan(first, count);
  const std::span<const StepProblem::Row> rows = std::span(attempt.problem.rows()).subspan(first, count);
  const SpringArray& springs = attempt.problem.springs();
  const auto at_first = [&](const std::vector<double>& numbers) { return load(&numbers[first]); };
  const contact::LawLanes law = contact::laws_of(contacts);
  contact::MemoryLanes memory = contact::memories_of(contacts);
  Lanes moved_normal{}, moved_shear{}, rotated_normal{}, rotated_shear{};
  if (drive.moves_contacts()) {
    moved_normal = moved_along(rows, false);
    moved_shear = moved_along(rows, true);
  }
  for (std::size_t i = 0; i < count && !drive.rotation.empty(); ++i) {
    rotated_normal[i] = drive.rotation[first + i].x;
    rotated_shear[i] = drive.rotation[first + i].y;
  }
  const Lanes bound = at_first(springs.bound), y = at_first(springs.y), w = at_first(springs.w),
              slipped = at_first(springs.slipped);
  const contact::SpringLanes s(contact::SpringLanes::Constants{.normal_stiffness = law.normal_stiffness,
                                                               .shear_stiffness = law.shear_stiffness,
                                                               .depth = law.depth,
                                                               .shear = memory.shear,
                                                               .bound = bound,
                                                               .tensile = at_first(springs.floor) < 0.0},
                               contact::SpringLanes::Shifted{at_first(springs.kn), at_first(springs.ks),
                                                             at_first(springs.y0) + moved_normal,
                                                             at_first(springs.w0) - moved_shear + slipped});
  const Lanes zero{}, normal = s.normal_force(y), shear = s.shear_force(w);
  const auto closed = s.closed(y), locked = s.locked(w);
  ContactAccounts accounts{
      .balance = s.balance(y, w, slipped),
      .stored_before = memory.stored,
      .input = -(normal * (moved_normal - rotated_normal) - shear * (moved_shear - rotated_shear)),
      .rotation = normal * rotated_normal - shear * rotated_shear,
      .penetration = s.penetration(y),
      .closed = where(closed, broadcast(1.0), zero)};
  accounts.leave_out_beyond(count);
  const Lanes pressure = where(normal > zero, normal, zero);
  memory.normal_force = pressure;
  memory.bounding_force = normal;
  if (!drive.is_static && attempt.model.solver.contact == ContactMethod::penalty) {
    const Lanes friction = at_first(springs.friction), constant = at_first(springs.constant);
    const auto slides = closed & ~locked & (friction > zero);
    const Lanes owed = pressure - (bound - constant) / where(slides, friction, broadcast(1.0));
    memory.bounding_force = where(slides, pressure + owed, normal);
  }
  memory.shear = where(closed, s.elastic_shear(w), zero);
  memory.stored = accounts.balance.stored;
  contact::keep(memory, count, [&](std::size_t i) -> contact::Memory& { return remembered[i]; });
  for (std::size_t i = 0; i < count; ++i) {
    remembered[i].state = closed[i] == 0   ? contact::State::open
                          : locked[i] != 0 ? contact::State::locked
                                           : contact::State::sliding;
    remembered[i].bonded = contacts[i].memory.bonded;
    remembered[i].bond_length = contacts[i].memory.bond_length;
  }
  return accounts;
}

/// What is otherwise with an augmented Lagrangian.
void StepAccounts::remember_multiplier(const Attempt& attempt, std::size_t c, std::size_t lane,
                                       contact::Memory& memory, ContactAccounts& accounts) {
  const contact::Contact& contact = attempt.contacts[c];
  const StepProblem::Row& row = attempt.problem.rows()[c];
  const contact::Spring s = attempt.problem.spring(contact, c);
  const double y = attempt.problem.springs().y[c], w = attempt.problem.springs().w[c];
  const Vec2 r = attempt.relative[c];
  const contact::Spring::Balance balance = s.rigid_balance(y, w, dot(row.normal, r), dot(row.tangent(), r));
  accounts.balance.stored[lane] = memory.stored = balance.stored;
  accounts.balance.friction[lane] = balance.friction;
  accounts.balance.damping[lane] = balance.damping;
  accounts.balance.numerical[lane] = balance.numerical;
  const double penetration = -(contact.gap + dot(row.normal, r));
  memory.offset = std::max(memory.offset, 0.0);
  accounts.penetration[lane] = 0.0;
  memory.multiplier = 0.0;
  if (accounts.closed[lane] != 0.0) {
    accounts.penetration[lane] = penetration - memory.offset;
    memory.multiplier = s.normal_force(y) / contact.normal_stiffness;
    memory.shear = s.shear_force(w) / contact.shear_stiffness;
  }
  memory.drift = memory.state == contact::State::locked ? memory.drift + dot(row.tangent(), r) : 0.0;
}

}  // namespace keyblock::dynamics
