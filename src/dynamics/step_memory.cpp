// What contacts remember for the next step, and where their energy went.
#include <algorithm>
#include <cmath>

#include "contact/contact_lanes.h"
#include "core/index.h"
#include "dynamics/step.h"

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

/// Of `count` contacts, at most as many as there are lanes, the first being contact `first`.
void Stepper::remember_contacts(std::size_t first, std::size_t count, const Drive& drive,
                                std::span<contact::Memory> remembered, ContactAccounts& accounts) {
  const std::span<const contact::Contact> contacts = std::span(contacts_).subspan(first, count);
  const std::span<const StepProblem::Row> rows = std::span(problem_.rows()).subspan(first, count);
  const SpringArray& springs = problem_.springs();
  const auto at_first = [&](const std::vector<double>& numbers) { return load(&numbers[first]); };
  const contact::LawLanes law = contact::laws_of(contacts);
  contact::MemoryLanes memory = contact::memories_of(contacts);
  Lanes moved_normal{}, moved_shear{}, turned_normal{}, turned_shear{};
  if (drive.moves_contacts()) {
    moved_normal = moved_along(rows, false);
    moved_shear = moved_along(rows, true);
  }
  for (std::size_t i = 0; i < count && !drive.turned.empty(); ++i) {
    turned_normal[i] = drive.turned[first + i].x;
    turned_shear[i] = drive.turned[first + i].y;
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
  accounts = {.balance = s.balance(y, w, slipped),
              .stored_before = memory.stored,
              .input = -(normal * (moved_normal - turned_normal) - shear * (moved_shear - turned_shear)),
              .turned = normal * turned_normal - shear * turned_shear,
              .penetration = s.penetration(y),
              .closed = where(closed, broadcast(1.0), zero)};
  accounts.leave_out_beyond(count);
  const Lanes pressure = where(normal > zero, normal, zero);
  memory.normal_force = pressure;
  memory.bounding_force = normal;
  if (!drive.is_static && model_.solver.contact == ContactMethod::penalty) {
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
}

/// What is otherwise with an augmented Lagrangian.
void Stepper::remember_multiplier(std::size_t c, std::size_t lane, contact::Memory& memory,
                                  ContactAccounts& accounts) {
  const StepProblem::Row& row = problem_.rows()[c];
  const contact::Spring s = problem_.spring(contacts_[c], c);
  const double y = problem_.springs().y[c], w = problem_.springs().w[c];
  const Vec2 r = open_close_.relative()[c];
  const contact::Spring::Balance balance = s.rigid_balance(y, w, dot(row.normal, r), dot(row.tangent(), r));
  accounts.balance.stored[lane] = memory.stored = balance.stored;
  accounts.balance.friction[lane] = balance.friction;
  accounts.balance.damping[lane] = balance.damping;
  accounts.balance.numerical[lane] = balance.numerical;
  const double penetration = -(contacts_[c].gap + dot(row.normal, r));
  memory.offset = std::max(memory.offset, 0.0);
  accounts.penetration[lane] = 0.0;
  memory.multiplier = 0.0;
  if (accounts.closed[lane] != 0.0) {
    accounts.penetration[lane] = penetration - memory.offset;
    memory.multiplier = s.normal_force(y) / contacts_[c].normal_stiffness;
    memory.shear = s.shear_force(w) / contacts_[c].shear_stiffness;
  }
  memory.drift = memory.state == contact::State::locked ? memory.drift + dot(row.tangent(), r) : 0.0;
}

double Stepper::gap(std::size_t k) const {
  const contact::Contact& c = contacts_[k];
  const StepProblem::Row& row = problem_.rows()[k];
  const SpringArray& springs = problem_.springs();
  // n·r; what multipliers have added is in both y₀ and y.
  const double normal = springs.y0[k] - springs.y[k] + dot(row.normal, row.moved);
  const bool has_multipliers = model_.solver.contact == ContactMethod::augmented_lagrangian;
  return c.gap + (has_multipliers ? std::max(c.memory.offset, 0.0) : c.memory.offset) + normal;
}

std::vector<Stepper::Force> Stepper::forces() const {
  const SpringArray& springs = problem_.springs();
  const std::size_t count = std::min(contacts_.size(), springs.size());
  std::vector<Force> forces;
  forces.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const SpringArray::Force force = springs.force(k);
    if (!(springs.y[k] > springs.floor[k])) {
      forces.push_back({force.normal, 0.0, contact::State::open});
      continue;
    }
    const bool holds = std::abs(springs.ks[k] * springs.w[k]) <= springs.bound[k];
    forces.push_back({force.normal, force.shear, holds ? contact::State::locked : contact::State::sliding});
  }
  return forces;
}

/// Contact memory for the next step, and where the energy of contacts went.
void Stepper::remember(State& state, const Drive& drive, StepReport& report) {
  // What was stored in contacts that have ended, a vertex that left its edge, is lost.
  state.ledger.numerical += state.contact_energy;
  state.contacts.make_room(contacts_.size());
  // Piece by piece, which are the same for any number of threads.
  constexpr std::size_t piece = 64 * lane_count;
  accounts_.assign((contacts_.size() + piece - 1) / piece, {});
  team_.for_range(accounts_.size(), contacts_worth_threads / piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t last = std::min(contacts_.size(), (p + 1) * piece);
      for (std::size_t c = p * piece; c < last; c += lane_count) {
        const std::size_t count = std::min<std::size_t>(lane_count, last - c);
        const std::span<contact::Memory> remembered = std::span(state.contacts.memory).subspan(c, count);
        ContactAccounts accounts;
        remember_contacts(c, count, drive, remembered, accounts);
        for (std::size_t i = 0; i < count; ++i) {
          if (model_.solver.contact != ContactMethod::penalty)
            remember_multiplier(c + i, i, remembered[i], accounts);
          state.contacts.track(c + i, contacts_[c + i].candidate);
        }
        accounts_[p].add(accounts);
      }
    }
  });
  ContactAccounts total;
  for (const ContactAccounts& accounts : accounts_) total.add(accounts);
  total.enter(state.ledger);
  state.contact_energy = sum(total.balance.stored);
  for (std::size_t i = 0; i < lane_count; ++i)
    report.penetration = std::max(report.penetration, total.penetration[i]);
  report.closed_contacts = static_cast<int>(sum(total.closed));
}

}  // namespace keyblock::dynamics
