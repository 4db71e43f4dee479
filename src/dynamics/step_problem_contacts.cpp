// The contacts of a step: what their relative displacement is made of, and their springs.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "contact/contact_lanes.h"
#include "core/index.h"
#include "core/known_size.h"
#include "dynamics/step_problem.h"

namespace keyblock::dynamics {

void StepProblem::build_rows(const State& state, const Drive& drive,
                             std::span<const contact::Contact> contacts, std::span<const int> pairs,
                             const ForContacts& for_contacts) {
  rows_.resize(contacts.size());
  if (most_vertices_ > 0) {
    on_curves_.resize(contacts.size());
    shares_on_curves_.resize(contacts.size() * most_vertices_);
  }
  springs_.resize(contacts.size());
  if (team_->size() > 1) unknowns_of_row_.resize(contacts.size());
  std::atomic<bool> may_break = false, lacks_room = false, has_distant = false;
  const auto of_some = [&](std::size_t begin, std::size_t end) {
    RowFacts all;
    for (std::size_t first = begin; first < end; first += lane_count) {
      const std::size_t last = std::min(first + lane_count, end);
      for (std::size_t k = first; k < last; ++k) {
        const RowFacts row = build_row(drive, contacts[k], pairs[at(contacts[k].candidate)], k);
        all.may_break |= row.may_break;
        all.lacks_room |= row.lacks_room;
        all.has_distant |= row.has_distant;
      }
      build_springs(state, drive, contacts.subspan(first, last - first), first);
    }
    if (all.may_break) may_break = true;
    if (all.lacks_room) lacks_room = true;
    if (all.has_distant) has_distant = true;
  };
  if (for_contacts) {
    for_contacts(of_some);
  } else {
    team_->for_range(contacts.size(), contacts_worth_threads, of_some);
  }
  may_break_ = may_break;
  lacks_room_ = lacks_room;
  has_distant_ = has_distant;
  if (team_->size() > 1) find_owners();
}

/// The unknown blocks of pieces of the rows.
void StepProblem::find_owners() {
  unknowns_of_piece_.resize((rows_.size() + rows_of_piece - 1) / rows_of_piece);
  team_->for_range(unknowns_of_piece_.size(), contacts_worth_threads / rows_of_piece,
                   [&](std::size_t begin, std::size_t end) {
                     for (std::size_t p = begin; p < end; ++p) {
                       std::pair<int, int> range{std::numeric_limits<int>::max(), -1};
                       const std::size_t last = std::min(rows_.size(), (p + 1) * rows_of_piece);
                       for (std::size_t c = p * rows_of_piece; c < last; ++c) {
                         for (const int unknown : {unknowns_of_row_[c].first, unknowns_of_row_[c].second}) {
                           if (unknown < 0) continue;  // fixed
                           range = {std::min(range.first, unknown), std::max(range.second, unknown)};
                         }
                       }
                       unknowns_of_piece_[p] = range;
                     }
                   });
}

void StepProblem::set_pairs(std::span<const contact::Contact> contacts, std::span<const int> pairs) {
  for (std::size_t c = 0; c < rows_.size(); ++c) rows_[c].pair = pairs[at(contacts[c].candidate)];
  lacks_room_ = false;
}

StepProblem::RowFacts StepProblem::build_row(const Drive& drive, const contact::Contact& contact, int pair,
                                             std::size_t c) {
  place_row(contact, c);
  Row& row = rows_[c];
  row.position = contact.position;
  row.unknown_a = bodies_[at(contact.block_a)].unknown;
  row.unknown_b = bodies_[at(contact.block_b)].unknown;
  row.pair = pair;
  row.normal = contact.normal;
  row.moved = drive.prescribed_between(contact);
  if (!drive.rotation.empty())
    row.moved += drive.rotation[c].x * row.normal + drive.rotation[c].y * row.tangent();
  if (team_->size() > 1) unknowns_of_row_[c] = {row.unknown_a, row.unknown_b};
  return {contact.memory.bonded && !contact.fused, pair == without_room, std::abs(row.position - 0.5) > 1.0};
}

/// The points of a row.
void StepProblem::place_row(const contact::Contact& contact, std::size_t c) {
  Row& row = rows_[c];
  row.vertex = static_cast<std::uint32_t>(contact.vertex);
  if (most_vertices_ > 0 && contact::is_curved(*surface_, contact.edge)) {
    const contact::DividedEdge& whole = surface_->divided[at(contact.edge)];
    on_curves_[c] = {contact.edge, whole.first, whole.pieces,
                     surface_->next[at(whole.first + whole.pieces - 1)]};
    double* share = &shares_on_curves_[c * most_vertices_];
    contact::for_curve_vertices(*surface_, contact.edge, contact.position,
                                [&](std::size_t, double of_vertex) { *share++ = of_vertex; });
    row.from = row.to = static_cast<std::uint32_t>(surface_->position.size() + c);
  } else {
    row.from = static_cast<std::uint32_t>(contact.edge);
    row.to = static_cast<std::uint32_t>(surface_->next[at(contact.edge)]);
  }
}

/// m, Δt times the velocity at the start of the step of a fixed block that is moved. What it goes in a step is the mean velocity of that.
Vec2 StepProblem::moved_at_start(const State& state, const Drive& drive, std::size_t b) const {
  if (drive.prescribed.empty() || model_->moves(b)) return {};
  const Block& block = model_->blocks[b];
  const Vec2 before =
      Vec2{state.velocity[block.first], state.velocity[block.first + 1]} / std::sqrt(block.area);
  return 0.5 * (drive.prescribed[b] + drive.step * before);
}

/// m along the tangent: what the sides of a contact that slides go against each other in the step until they have the same velocity.
double StepProblem::way_to_rest(const State& state, const Drive& drive, const contact::Contact& contact,
                                const Row& row) const {
  const Integrator& rule = drive.rule[at(row.unknown_a >= 0 ? contact.block_a : contact.block_b)];
  const double dt = drive.step;
  Vec2 way = rule.rest_share() *
             (dt * relative(row, state.velocity) + moved_at_start(state, drive, at(contact.block_a)) -
              moved_at_start(state, drive, at(contact.block_b)));
  if (rule.rest_share_of_acceleration() != 0.0)
    way += rule.rest_share_of_acceleration() * dt * dt * relative(row, state.acceleration);
  const double along = dot(row.tangent(), way);
  return along * contact.memory.shear > 0.0 ? along : 0.0;
}

/// The same of several contacts, zero of those that do not slide. Their springs are not to hold them before: what was left of the
/// velocity would be sent back, and swing at the frequency of the steps.
Lanes StepProblem::ways_to_rest(const State& state, const Drive& drive,
                                std::span<const contact::Contact> contacts, std::size_t first) const {
  Lanes ways{};
  if (drive.is_static || model_->solver.contact != ContactMethod::penalty) return ways;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].memory.state == contact::State::sliding)
      ways[i] = way_to_rest(state, drive, contacts[i], rows_[first + i]);
  }
  return ways;
}

/// Of as many contacts as there are lanes, or fewer, the first of them being contact `first`.
void StepProblem::build_springs(const State& state, const Drive& drive,
                                std::span<const contact::Contact> contacts, std::size_t first) {
  const contact::LawLanes law = contact::laws_of(contacts);
  const contact::MemoryLanes memory = contact::memories_of(contacts);
  const Lanes a =
      contact::lanes_of(contacts, [&](const contact::Contact& c) { return bodies_[at(c.block_a)].mass; });
  const Lanes b =
      contact::lanes_of(contacts, [&](const contact::Contact& c) { return bodies_[at(c.block_b)].mass; });
  const Lanes mass = where(a == 0.0, b, where(b == 0.0, a, a * b / (a + b)));
  const auto fused = contact::lanes_where(contacts, [](const contact::Contact& c) { return c.fused; });
  const auto bonded =
      contact::lanes_where(contacts, [](const contact::Contact& c) { return c.memory.bonded; });
  const auto tensile = fused | (bonded & (law.tension > 0.0));
  const Lanes damping = broadcast(drive.is_static ? 0.0 : 2.0 * model_->solver.contact_damping / drive.step);
  const Lanes normal = memory.bounding_normal(),
              constant = law.cohesion + law.friction * (drive.owed_share * memory.owed());
  const Lanes bound =
      where(fused, broadcast(HUGE_VAL), contact::shear_strength(law.friction, normal, constant));
  const contact::SpringLanes spring(contact::SpringLanes::Constants{
      law.normal_stiffness, law.shear_stiffness, damping * square_root(law.normal_stiffness * mass),
      damping * square_root(law.shear_stiffness * mass), law.depth, memory.shear, bound, tensile});
  const std::size_t count = contacts.size();
  const auto keep = [&](std::vector<double>& numbers, Lanes v) {
    if (count == lane_count) return store(&numbers[first], v);
    store_first(&numbers[first], v, static_cast<int>(count));
  };
  keep(springs_.kn, spring.normal_stiffness());
  keep(springs_.ks, spring.shear_stiffness());
  keep(springs_.bound, bound);
  keep(springs_.floor, where(tensile, broadcast(-HUGE_VAL), Lanes{}));
  keep(springs_.friction, where(fused, broadcast(-1.0), law.friction));
  keep(springs_.constant, constant);
  // The pieces that acted in the last step. What is fused never slides, whatever it did.
  const auto was = [&](contact::State what) {
    return contact::lanes_where(contacts, [&](const contact::Contact& c) { return c.memory.state == what; });
  };
  const auto slips = (bound > 0.0) & ~(was(contact::State::locked) | fused),
             forward = slips & (spring.shear() > 0.0), backward = slips & (spring.shear() < 0.0),
             none = ~(bound > 0.0) | (slips & ~forward & ~backward);
  springs_.set_branches(first, count,
                        SpringArray::codes_of(tensile | ~was(contact::State::open), none, forward, backward));
  const Lanes slipped = ways_to_rest(state, drive, contacts, first);
  keep(springs_.slipped, slipped);
  Lanes y = spring.depth(), w = spring.shear() - slipped;
  if (drive.moves_contacts()) {
    for (std::size_t i = 0; i < count; ++i) {
      const Row& row = rows_[first + i];
      y[i] -= dot(row.normal, row.moved);
      w[i] += dot(row.tangent(), row.moved);
    }
  }
  keep(springs_.y0, y);
  keep(springs_.y, y);
  keep(springs_.w0, w);
  keep(springs_.w, w);
}

contact::Spring StepProblem::spring(const contact::Contact& contact, std::size_t c) const {
  const Row& row = rows_[c];
  return {{.normal_stiffness = contact.normal_stiffness,
           .shear_stiffness = contact.shear_stiffness,
           .depth = contact.depth,
           .shear = contact.memory.shear,
           .bound = springs_.bound[c],
           .tensile = springs_.is_tensile(c)},
          {springs_.kn[c], springs_.ks[c], springs_.y0[c] + dot(row.normal, row.moved),
           springs_.w0[c] - dot(row.tangent(), row.moved) + springs_.slipped[c]}};
}

double StepProblem::reduced_mass(const contact::Contact& c) const {
  const double a = bodies_[at(c.block_a)].mass, b = bodies_[at(c.block_b)].mass;
  return a == 0.0 ? b : b == 0.0 ? a : a * b / (a + b);
}

double StepProblem::inertia_between(const contact::Contact& c) const {
  const std::size_t moves = at(model_->blocks[at(c.block_a)].fixed ? c.block_b : c.block_a);
  return reduced_mass(c) * terms_.inertia(moves) / model_->blocks[moves].material.density;
}

}  // namespace keyblock::dynamics
