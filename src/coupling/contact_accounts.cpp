// What contacts remember for the next step, and where their energy went.
#include <algorithm>
#include <cmath>

#include "contact/contact_lanes.h"
#include "contact/law.h"
#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/contact_coupling.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

namespace {

/// n·moved or t·moved of each row, moved: the known part of its r.
Lanes moved_along(std::span<const Row> rows, bool tangent) {
  Lanes along{};
  for (std::size_t i = 0; i < rows.size(); ++i)
    along[i] = dot(tangent ? rows[i].tangent() : rows[i].normal, rows[i].moved);
  return along;
}

/// Where the energy of as many contacts as there are lanes went in the step, and how deep they are.
struct ContactAccounts {
  contact::SpringLanes::Balance balance;
  Lanes stored_before{};  ///< J per thickness, at the start
  Lanes input{};          ///< J per thickness, by what fixed blocks are moved
  Lanes earlier{};        ///< J per thickness, of which: by forces at the start in place of those at the end
  Lanes rotation{};       ///< J per thickness, of the forces over Drive::rotation: no block gets it
  Lanes penetration{};    ///< m
  Lanes closed{};         ///< at the end: 1, else 0
  void add(const ContactAccounts& other);
  /// Zero where a lane is none of the first `count`.
  void leave_out_beyond(std::size_t count);
  void enter(EnergyLedger& ledger) const;
};

void ContactAccounts::add(const ContactAccounts& other) {
  balance.stored += other.balance.stored;
  balance.friction += other.balance.friction;
  balance.damping += other.balance.damping;
  balance.numerical += other.balance.numerical;
  stored_before += other.stored_before;
  input += other.input;
  earlier += other.earlier;
  rotation += other.rotation;
  penetration = largest(penetration, other.penetration);
  closed += other.closed;
}

void ContactAccounts::leave_out_beyond(std::size_t count) {
  if (count >= lane_count) return;
  for (Lanes* lanes : {&balance.stored, &balance.friction, &balance.damping, &balance.numerical,
                       &stored_before, &input, &earlier, &rotation, &penetration, &closed})
    *lanes = where(first_lanes(count), *lanes, Lanes{});
}

void ContactAccounts::enter(EnergyLedger& ledger) const {
  ledger.friction += sum(balance.friction);
  ledger.input += sum(input);
  ledger.damping += sum(balance.damping);
  ledger.numerical += sum(balance.numerical) + sum(rotation) - sum(stored_before) + sum(earlier);
}

/// Where a contact shares the pressure of faces, its own normal spring has what is left of its stiffness. first: the number of the first contact.
contact::LawLanes laws_in_step(std::span<const contact::Contact> contacts, const SpringArray& springs,
                               std::size_t first) {
  contact::LawLanes law = contact::laws_of(contacts);
  for (std::size_t i = 0; i < contacts.size() && !springs.faces.empty(); ++i) {
    if (springs.faces.has(first + i))
      law.normal_stiffness[i] = springs.kn[first + i] * springs.faces.elastic_share(first + i);
  }
  return law;
}

/// What the work of contacts takes of their forces at the start of the step (Integrator::end_share_of_work).
Lanes shares_of_start(const Drive& drive, std::span<const contact::Contact> contacts,
                      std::span<const Row> rows) {
  Lanes shares{};
  for (std::size_t i = 0; i < contacts.size(); ++i)
    shares[i] = 1.0 - drive.end_share_of_work(contacts[i], rows[i].unknown_a >= 0);
  return shares;
}

/// The state of contacts and what a solution does not change, beside the numbers that are kept in lanes.
void remember_states(std::span<const contact::Contact> contacts, const Lanes& closed, const Lanes& locked,
                     std::span<contact::Memory> remembered) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    remembered[i].state = closed[i] == 0.0   ? contact::State::open
                          : locked[i] != 0.0 ? contact::State::locked
                                             : contact::State::sliding;
    remembered[i].bonded = contacts[i].memory.bonded;
    remembered[i].in_face = contacts[i].memory.in_face;
    remembered[i].is_torn = contacts[i].memory.is_torn;
    remembered[i].piece = contacts[i].memory.piece;
  }
}

/// Joints without tensile strength have cohesion until their joint has opened by more than a joint in place may: where it only gapes, its sides
/// still interlock. Those that keep cohesion when they slip hold while they gape, so that the heel of a block that leans on its toe counts in
/// full, as in limit equilibrium.
struct KeptCohesion {
  LaneCondition holds, is_lost;
};
KeptCohesion kept_cohesion(const Attempt& attempt, std::span<const contact::Contact> contacts,
                           const contact::SpringLanes& springs, Lanes y) {
  const auto none = Lanes{} > Lanes{};
  if (!attempt.problem.facts().may_break) return {none, none};
  const Lanes most = broadcast(contact::Tolerances(attempt.model.block_size).in_place);
  const auto keeps = contact::lanes_where(contacts, &contact::Contact::keeps_cohesion),
             lets_go = contact::lanes_where(contacts, &contact::Contact::is_lost_by_opening),
             is_in_place = springs.penetration(y) >= -most;
  return {keeps & is_in_place, lets_go & ~is_in_place};
}

/// The normal force that contacts bear, and that which bounds their friction in the next step. borne: N per thickness, negative in the tension of a
/// bond. slides: the bound was reached, and what it missed of Coulomb's law is owed.
void remember_forces(const Attempt& attempt, std::size_t first, Lanes borne, LaneCondition slides,
                     contact::MemoryLanes& memory) {
  const Lanes zero{}, pressure = where(borne > zero, borne, zero);
  memory.normal_force = pressure;
  memory.bounding_force = borne;
  if (attempt.drive.is_static) return;
  const SpringArray& springs = attempt.problem.springs();
  const Lanes friction = load(&springs.friction[first]), constant = load(&springs.constant[first]);
  const auto owes = slides & (friction > zero);
  const Lanes owed =
      pressure - (load(&springs.bound[first]) - constant) / where(owes, friction, broadcast(1.0));
  memory.bounding_force = where(owes, pressure + owed, borne);
}

/// Of `count` contacts, at most as many as there are lanes, the first being contact `first`.
ContactAccounts remember_some(const Attempt& attempt, std::size_t first, std::size_t count,
                              std::span<contact::Memory> remembered) {
  const Drive& drive = attempt.drive;
  const std::span<const contact::Contact> contacts = attempt.contacts.subspan(first, count);
  const std::span<const Row> rows = std::span(attempt.problem.rows()).subspan(first, count);
  const SpringArray& springs = attempt.problem.springs();
  const auto at_first = [&](const std::vector<double>& numbers) { return load(&numbers[first]); };
  const contact::LawLanes law = laws_in_step(contacts, springs, first);
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
                                                               .tensile = at_first(springs.low) < 0.0},
                               contact::SpringLanes::Shifted{at_first(springs.kn), at_first(springs.ks),
                                                             at_first(springs.y0) + moved_normal,
                                                             at_first(springs.w0) - moved_shear + slipped});
  const Lanes zero{}, pressed = springs.faces.forces(first), normal = s.normal_force(y) + pressed,
                      shear = s.shear_force(w);
  const auto in_face = (pressed < zero) | (pressed > zero), locked = s.locked(w);
  const KeptCohesion cohesion = kept_cohesion(attempt, contacts, s, y);
  const auto holds = in_face | cohesion.holds, closed = s.closed(y) | holds;
  // What the pressure of a face stored in the last step is no more what its contacts have alone, nor the other way round.
  const auto other = contact::lanes_where(
      contacts, [](const contact::Contact& c) { return c.memory.in_face || c.was_in_face; });
  ContactAccounts accounts{
      .balance = s.balance(y, w, slipped, holds),
      .stored_before = where(other, s.stored_at_start(), memory.stored),
      .input = -(normal * (moved_normal - rotated_normal) - shear * (moved_shear - rotated_shear)),
      .rotation = normal * rotated_normal - shear * rotated_shear,
      .penetration = s.penetration(y),
      .closed = where(closed, broadcast(1.0), zero)};
  if (!drive.prescribed.empty()) {
    // A bond's force has a sign, which the pressure that is remembered has not.
    const Lanes at_start =
        where(at_first(springs.low) < zero, law.normal_stiffness * law.depth, memory.normal_force);
    accounts.earlier = shares_of_start(drive, contacts, rows) *
                       ((law.shear_stiffness * memory.shear - shear) * (moved_shear - rotated_shear) -
                        (at_start - normal) * (moved_normal - rotated_normal));
    accounts.input += accounts.earlier;
  }
  accounts.leave_out_beyond(count);
  // Of faces what the contact bears: what its nodal force is beyond that belongs to others.
  remember_forces(attempt, first, s.normal_force(y) + springs.faces.bearings(first), closed & ~locked,
                  memory);
  memory.shear = where(closed, s.elastic_shear(w), zero);
  memory.stored = accounts.balance.stored;
  contact::keep(memory, count, [&](std::size_t i) -> contact::Memory& { return remembered[i]; });
  remember_states(contacts, accounts.closed, where(locked, broadcast(1.0), zero), remembered);
  const Lanes is_lost = where(cohesion.is_lost, broadcast(1.0), zero);
  for (std::size_t i = 0; i < count; ++i) remembered[i].bonded &= is_lost[i] == 0.0;
  return accounts;
}

/// Slip of the step wears the joint of a contact whose strength falls with it. The step had the strength of its start, and owes that of the
/// place in the step for which its force stands: strength falls in a straight line with slip. What is left of friction at the end has to pay, as far as it
/// can.
void wear(const Attempt& attempt, std::size_t c, contact::Memory& memory) {
  const contact::Contact& contact = attempt.contacts[c];
  const SpringArray& springs = attempt.problem.springs();
  if (memory.state != contact::State::sliding || !attempt.drive.wears_joints) return;
  const double elastic = springs.force(c).shear / springs.ks[c],
               slip = std::abs(springs.w[c] - elastic + springs.slipped[c]);
  memory.worn += slip;
  if (attempt.drive.is_static || !contact.loss.is_any()) return;
  const Integrator& rule =
      attempt.drive.rule[at(attempt.problem.rows()[c].unknown_a >= 0 ? contact.block_a : contact.block_b)];
  const contact::StrengthLoss lost = contact.loss.after(rule.place_of_force() * slip);
  const double at_end = springs.friction[c] - contact.loss.after(slip).friction;
  if (!(at_end > 0.0)) return;
  const double right =
      (springs.friction[c] - lost.friction) * memory.normal_force + springs.constant[c] - lost.cohesion;
  memory.bounding_force = memory.normal_force + (right - springs.bound[c]) / at_end;
}

ContactAccounts remember_piece(const Attempt& attempt, std::size_t first, std::size_t last,
                               contact::CandidateList& list) {
  ContactAccounts sum;
  for (std::size_t c = first; c < last; c += lane_count) {
    const std::size_t count = std::min<std::size_t>(lane_count, last - c);
    const std::span<contact::Memory> remembered = std::span(list.memory).subspan(c, count);
    const ContactAccounts accounts = remember_some(attempt, c, count, remembered);
    for (std::size_t i = 0; i < count; ++i) {
      if (remembered[i].piece >= 0) wear(attempt, c + i, remembered[i]);
      list.track(c + i, attempt.contacts[c + i].candidate);
    }
    sum.add(accounts);
  }
  return sum;
}

}  // namespace

namespace {

/// What contacts have worn goes to their pieces of joint. Several contacts may share one: it has the slip of the one that slipped most.
void wear_pieces(contact::CandidateList& list) {
  for (contact::JointPiece& piece : list.pieces) piece.is_touched = false;
  for (std::size_t k = 0; k < list.memory.size() && !list.pieces.empty(); ++k) {
    const contact::Memory& memory = list.memory[k];
    if (memory.piece < 0) continue;
    contact::JointPiece& piece = list.pieces[at(memory.piece)];
    piece.worn = std::max(piece.worn, memory.worn);
    piece.is_touched = true;
  }
}

/// Where the energy of the pressure of faces went in the step, beside that of the springs of their contacts. Each contact keeps its share of what
/// is stored, ½ F_i x_i, which is negative at an open end.
void account_for_faces(const Attempt& attempt, State& state) {
  const SpringArray& springs = attempt.problem.springs();
  const FaceSprings& faces = springs.faces;
  std::vector<double> start, end, force, elastic;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::span<const std::size_t> rows = faces.rows_of(f);
    start.clear();
    end.clear();
    force.resize(rows.size());
    elastic.resize(rows.size());
    double gone = 0.0;  // J per thickness, that the pressure has taken up
    faces.forces_at(f, springs.y, springs.y, 0.0, force);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Row& row = attempt.problem.rows()[rows[i]];
      const double way = springs.y[rows[i]] - springs.y0[rows[i]] -
                         (attempt.drive.moves_contacts() ? dot(row.normal, row.moved) : 0.0);
      start.push_back(attempt.contacts[rows[i]].depth);
      end.push_back(start.back() + way);
      gone += force[i] * way;
    }
    faces.elastic_pressure(f).forces(end, elastic);
    double stored = 0.0, damped = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double share = 0.5 * elastic[i] * end[i];
      state.contacts.memory[rows[i]].stored += share;
      stored += share;
      damped += (force[i] - elastic[i]) * (end[i] - start[i]);
    }
    state.contact_energy += stored;
    state.ledger.damping += damped;
    state.ledger.numerical += gone - stored - damped;
  }
}

}  // namespace

CouplingTotals ContactCoupling::account(const Attempt& attempt, std::span<const double> /*spin*/,
                                        std::size_t /*first*/, std::span<double> /*memory*/,
                                        State& state) const {
  const std::size_t contacts = attempt.contacts.size();
  // What was stored in contacts that have ended, a vertex that left its edge, is lost.
  state.ledger.numerical += state.contact_energy;
  state.contacts.make_room(contacts);
  // Piece by piece, which are the same for any number of threads.
  constexpr std::size_t size = 64 * lane_count;
  std::vector<ContactAccounts> pieces((contacts + size - 1) / size);
  attempt.team.for_range(
      pieces.size(), contacts_worth_threads / size, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
          pieces[p] = remember_piece(attempt, p * size, std::min(contacts, (p + 1) * size), state.contacts);
      });
  ContactAccounts total;
  for (const ContactAccounts& accounts : pieces) total.add(accounts);
  total.enter(state.ledger);
  state.contact_energy = sum(total.balance.stored);
  account_for_faces(attempt, state);
  wear_pieces(state.contacts);
  CouplingTotals totals;
  for (std::size_t i = 0; i < lane_count; ++i)
    totals.penetration = std::max(totals.penetration, total.penetration[i]);
  totals.closed = static_cast<int>(sum(total.closed));
  return totals;
}

}  // namespace keyblock::dynamics
