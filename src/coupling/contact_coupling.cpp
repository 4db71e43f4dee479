#include "coupling/contact_coupling.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>

#include "contact/contact_lanes.h"
#include "contact/joint_faces.h"
#include "core/index.h"
#include "coupling/impact.h"
#include "coupling/points.h"
#include "coupling/row_owners.h"
#include "coupling/step_problem.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

namespace {

/// m, Δt times the velocity at the start of the step of a fixed block that is moved. What it goes in a step is the mean velocity of that.
Vec2 moved_at_start(const Model& model, const State& state, const Drive& drive, std::size_t b) {
  if (drive.prescribed.empty() || model.moves(b)) return {};
  const Block& block = model.blocks[b];
  const Vec2 before =
      Vec2{state.velocity[block.first], state.velocity[block.first + 1]} / std::sqrt(block.area);
  return 0.5 * (drive.prescribed[b] + drive.step * before);
}

/// m along the tangent: what the sides of a contact that slides go against each other in the step until they have the same velocity.
double way_to_rest(const Model& model, const State& state, const Drive& drive, const Points& points,
                   const contact::Contact& contact, const Row& row) {
  const Integrator& rule = drive.rule[at(row.unknown_a >= 0 ? contact.block_a : contact.block_b)];
  const double dt = drive.step;
  Vec2 way = rule.rest_share() * (dt * relative_displacement(points, row, state.velocity) +
                                  moved_at_start(model, state, drive, at(contact.block_a)) -
                                  moved_at_start(model, state, drive, at(contact.block_b)));
  if (rule.rest_share_of_acceleration() != 0.0)
    way +=
        rule.rest_share_of_acceleration() * dt * dt * relative_displacement(points, row, state.acceleration);
  const double along = dot(row.tangent(), way);
  return along * contact.memory.shear > 0.0 ? along : 0.0;
}

/// The same of several contacts, zero of those that do not slide. Their springs are not to hold them before: what was left of the
/// velocity would be sent back, and swing at the frequency of the steps.
Lanes ways_to_rest(const Model& model, const State& state, const Drive& drive, const Points& points,
                   std::span<const contact::Contact> contacts, std::span<const Row> rows) {
  Lanes ways{};
  if (drive.is_static) return ways;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].memory.state == contact::State::sliding)
      ways[i] = way_to_rest(model, state, drive, points, contacts[i], rows[i]);
  }
  return ways;
}

/// Whether the sides of a contact are blocks that strike each other there in the step.
bool meets_impact(const Model& model, const State& state, const Drive& drive, const Points& points,
                  const contact::Contact& c, const Row& row) {
  const auto strikes = [&](int b) { return model.moves(at(b)) && drive.in_impact[at(b)] != 0; };
  const auto may_meet = [&](int b) { return strikes(b) || !model.moves(at(b)); };
  if (!may_meet(c.block_a) || !may_meet(c.block_b) || !(strikes(c.block_a) || strikes(c.block_b)))
    return false;
  const double speed = speed_of_approach(state, drive, points, c, row);
  return speed > drive.impact_speed && !has_met_before(c, speed, drive) && -c.depth < speed * drive.step;
}

/// How contacts of blocks that strike each other are met, zero of all others.
struct Impacts {
  Lanes
      held_off{};  ///< m, gap at which they are: D there is Δt v (θ − e)/(1 + θ), of which v′ = −e v is made
  /// N/m per thickness, the least stiffness: blocks strike each other in one step, whatever the joint yields.
  Lanes stiffness{};
};

Impacts impacts_of(const Model& model, const State& state, const Drive& drive, const Points& points,
                   std::span<const contact::Contact> contacts, std::span<const Row> rows, Lanes mass) {
  constexpr double stiff = 1000.0;  // of the inertia of the step: e is met to 0.2 %
  Impacts impacts;
  for (std::size_t i = 0; i < contacts.size() && !drive.in_impact.empty(); ++i) {
    const contact::Contact& c = contacts[i];
    if (!meets_impact(model, state, drive, points, c, rows[i])) continue;
    const double speed = speed_of_approach(state, drive, points, c, rows[i]), gap = -c.depth,
                 theta = drive.rule[at(model.moves(at(c.block_a)) ? c.block_a : c.block_b)].inertia() - 1.0,
                 way = drive.step * speed * (theta - model.solver.restitution) / (1.0 + theta);
    impacts.held_off[i] = std::max(0.0, gap - std::max(0.0, way));
    impacts.stiffness[i] = stiff * mass[i] / (drive.step * drive.step);
  }
  return impacts;
}

/// Of as many contacts as there are lanes, or fewer, with their rows; the first of them is contact `first`.
void build_springs(const Model& model, const State& state, const Drive& drive,
                   std::span<const contact::Contact> contacts, std::size_t first, const CouplingRows& out) {
  SpringArray& springs = out.springs;
  const std::span<const Row> rows = out.rows.subspan(first, contacts.size());
  const contact::LawLanes law = contact::laws_of(contacts);
  const contact::MemoryLanes memory = contact::memories_of(contacts);
  const Lanes a = contact::lanes_of(
      contacts, [&](const contact::Contact& c) { return out.points.body(at(c.block_a)).mass; });
  const Lanes b = contact::lanes_of(
      contacts, [&](const contact::Contact& c) { return out.points.body(at(c.block_b)).mass; });
  const Lanes mass = where(a == 0.0, b, where(b == 0.0, a, a * b / (a + b)));
  const auto fused = contact::lanes_where(contacts, [](const contact::Contact& c) { return c.fused; });
  const auto bonded =
      contact::lanes_where(contacts, [](const contact::Contact& c) { return c.memory.bonded; });
  const auto tensile = fused | (bonded & (law.tension > 0.0));
  const Lanes damping = broadcast(drive.is_static ? 0.0 : 2.0 * model.solver.contact_damping / drive.step),
              viscous = broadcast(drive.is_static ? 0.0 : stiffness_damping(model) / drive.step);
  const auto dashpot = [&](Lanes stiffness) {
    return damping * square_root(stiffness * mass) + viscous * stiffness;
  };
  const Lanes normal = memory.bounding_normal(),
              constant = law.cohesion + law.friction * (drive.owed_share * memory.owed());
  const Lanes bound =
      where(fused, broadcast(HUGE_VAL), contact::shear_strength(law.friction, normal, constant));
  const contact::SpringLanes spring(contact::SpringLanes::Constants{
      law.normal_stiffness, law.shear_stiffness, dashpot(law.normal_stiffness), dashpot(law.shear_stiffness),
      law.depth, memory.shear, bound, tensile});
  const std::size_t count = contacts.size();
  const auto keep = [&](std::vector<double>& numbers, Lanes v) {
    if (count == lane_count) return store(&numbers[first], v);
    store_first(&numbers[first], v, static_cast<int>(count));
  };
  const Impacts impacts = impacts_of(model, state, drive, out.points, contacts, rows, mass);
  keep(springs.kn, largest(spring.normal_stiffness(), impacts.stiffness));
  keep(springs.ks, spring.shear_stiffness());
  keep(springs.bound, bound);
  keep(springs.least, -bound);
  keep(springs.low, contact::normal_spring(Lanes{}, tensile).low);
  keep(springs.friction, where(fused, broadcast(-1.0), law.friction));
  keep(springs.constant, constant);
  // The branches of the last step. What is fused never slides, whatever it did.
  const auto was = [&](contact::State what) {
    return contact::lanes_where(contacts, [&](const contact::Contact& c) { return c.memory.state == what; });
  };
  const auto slips = (bound > 0.0) & ~(was(contact::State::locked) | fused),
             forward = slips & (spring.shear() > 0.0), backward = slips & (spring.shear() < 0.0),
             none = ~(bound > 0.0) | (slips & ~forward & ~backward);
  springs.set_branches(first, count,
                       SpringArray::codes_of(tensile | ~was(contact::State::open), none, forward, backward));
  const Lanes slipped = ways_to_rest(model, state, drive, out.points, contacts, rows);
  keep(springs.slipped, slipped);
  Lanes y = spring.depth() + impacts.held_off, w = spring.shear() - slipped;
  if (drive.moves_contacts()) {
    for (std::size_t i = 0; i < count; ++i) {
      y[i] -= dot(rows[i].normal, rows[i].moved);
      w[i] += dot(rows[i].tangent(), rows[i].moved);
    }
  }
  keep(springs.y0, y);
  keep(springs.y, y);
  keep(springs.w0, w);
  keep(springs.w, w);
}

}  // namespace

void ContactCoupling::add_pairs(BlockPairs& pairs) const {
  for (const contact::Contact& c : contacts_) {
    const std::pair pair(c.block_a, c.block_b);
    if (pairs.empty() || pairs.back() != pair) pairs.push_back(pair);
  }
}

RowFacts ContactCoupling::build(const Model& model, const State& state, const Drive& drive,
                                std::span<const double> /*memory*/, CouplingRows out) const {
  std::atomic<bool> may_break = false, lacks_room = false, has_distant = false;
  const auto of_some = [&](std::size_t begin, std::size_t end) {
    RowFacts facts;
    for (std::size_t first = begin; first < end; first += lane_count) {
      const std::size_t last = std::min(first + lane_count, end);
      for (std::size_t c = first; c < last; ++c) facts |= build_row(drive, c, out);
      build_springs(model, state, drive, contacts_.subspan(first, last - first), first, out);
    }
    if (facts.may_break) may_break = true;
    if (facts.lacks_room) lacks_room = true;
    if (facts.has_distant) has_distant = true;
  };
  if (for_contacts_) {
    for_contacts_(of_some);
  } else {
    out.team.for_range(contacts_.size(), contacts_worth_threads, of_some);
  }
  if (find_faces_) build_faces(model, state, drive, out);
  return {.may_break = may_break, .lacks_room = lacks_room, .has_distant = has_distant};
}

/// Of each contact, dashpot over stiffness: the same for all contacts of two blocks, by the stiffest of them.
std::vector<double> ContactCoupling::dashpots_of_faces(const Model& model, const Drive& drive,
                                                       const Points& points) const {
  std::vector<double> dashpot(contacts_.size(), 0.0);
  if (drive.is_static) return dashpot;
  const double damping = 2.0 * model.solver.contact_damping / drive.step,
               viscous = stiffness_damping(model) / drive.step;
  const auto are_of_same_blocks = [&](const contact::Contact& a, const contact::Contact& b) {
    return std::minmax(a.block_a, a.block_b) == std::minmax(b.block_a, b.block_b);
  };
  for (std::size_t c = 0; c < contacts_.size();) {
    std::size_t end = c;
    double stiffest = 0.0;
    for (; end < contacts_.size() && are_of_same_blocks(contacts_[c], contacts_[end]); ++end)
      stiffest = std::max(stiffest, contacts_[end].normal_stiffness);
    const double of_pair = damping * std::sqrt(reduced_mass(points, contacts_[c]) / stiffest) + viscous;
    for (; c < end; ++c) dashpot[c] = of_pair;
  }
  return dashpot;
}

/// Normal springs of contacts that share the pressure of faces have what is left of their stiffness. Spring and dashpot of a face are one spring
/// about a shifted origin, as those of a contact. All contacts of two blocks have the same dashpot for their stiffness then. Where a face is
/// closed is a matter of all its contacts: those that are open are shifted with those that press. A face that is struck has no pressure: its
/// contacts hold the blocks apart where the impact asks for it.
void ContactCoupling::build_faces(const Model& model, const State& state, const Drive& drive,
                                  const CouplingRows& out) const {
  const contact::JointFaces& faces = find_faces_();
  if (faces.empty()) return;
  SpringArray& springs = out.springs;
  springs.faces.begin(springs.size());
  const std::vector<double> dashpot = dashpots_of_faces(model, drive, out.points);
  std::vector<std::size_t> rows;
  std::vector<std::uint8_t> presses(contacts_.size(), 0);
  for (const contact::JointFace& face : faces.all()) {
    const std::span<const std::size_t> of_face = faces.contacts_of(face);
    const auto is_struck = [&](std::size_t c) {
      return meets_impact(model, state, drive, out.points, contacts_[c], out.rows[c]);
    };
    if (!drive.in_impact.empty() && std::ranges::any_of(of_face, is_struck)) continue;
    const auto is_pressed = [&](std::size_t c) { return contacts_[c].depth > 0.0; };
    const bool shifts = face.pressure.pulls() || std::ranges::any_of(of_face, is_pressed);
    rows.clear();
    for (const std::size_t c : of_face) {
      rows.push_back(out.first + c);
      presses[c] |= static_cast<std::uint8_t>(shifts);
    }
    springs.faces.add(face.pressure, dashpot[of_face.front()], rows);
  }
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    if (springs.faces.has(out.first + c))
      set_row_of_face(c, faces.left()[c], dashpot[c], presses[c] != 0, drive, out);
  }
  springs.press_faces();
}

/// Its own normal spring, of the stiffness that no face has. shifts: with those that press.
void ContactCoupling::set_row_of_face(std::size_t c, double stiffness, double dashpot, bool shifts,
                                      const Drive& drive, const CouplingRows& out) const {
  SpringArray& springs = out.springs;
  const std::size_t k = out.first + c;
  const double moved = drive.moves_contacts() ? dot(out.rows[c].normal, out.rows[c].moved) : 0.0;
  springs.kn[k] = stiffness * (1.0 + dashpot);
  springs.y0[k] = springs.y[k] = contacts_[c].depth / (shifts ? 1.0 + dashpot : 1.0) - moved;
  if (springs.kn[k] == 0.0) springs.low[k] = 0.0;  // there is no spring that could pull
  springs.set_branch(k, springs.branch[k]);
}

RowFacts ContactCoupling::build_row(const Drive& drive, std::size_t c, const CouplingRows& out) const {
  const contact::Contact& contact = contacts_[c];
  Row& row = out.rows[c];
  row.vertex = static_cast<std::uint32_t>(contact.vertex);
  std::tie(row.from, row.to) = out.points.place_contact(contact, c);
  row.position = contact.position;
  row.unknown_a = out.points.body(at(contact.block_a)).unknown;
  row.unknown_b = out.points.body(at(contact.block_b)).unknown;
  row.pair = pairs_[at(contact.candidate)];
  row.normal = contact.normal;
  row.moved = drive.prescribed_between(contact);
  if (!drive.rotation.empty())
    row.moved += drive.rotation[c].x * row.normal + drive.rotation[c].y * row.tangent();
  out.owners.set(c, row.unknown_a, row.unknown_b);
  return {.may_break = contact.memory.bonded && !contact.fused,
          .lacks_room = row.pair == Row::without_room,
          .has_distant = std::abs(row.position - 0.5) > 1.0};
}

double reduced_mass(const Points& points, const contact::Contact& c) {
  const double a = points.body(at(c.block_a)).mass, b = points.body(at(c.block_b)).mass;
  return a == 0.0 ? b : b == 0.0 ? a : a * b / (a + b);
}

double inertia_between(const StepProblem& problem, const contact::Contact& c) {
  const Model& model = problem.model();
  const std::size_t moves = at(model.blocks[at(c.block_a)].fixed ? c.block_b : c.block_a);
  return reduced_mass(problem.points(), c) * problem.terms().inertia(moves) /
         model.blocks[moves].material.density;
}

}  // namespace keyblock::dynamics
