#include "contact/detection.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/index.h"

namespace keyblock::contact {

namespace {

/// Whether the edge from v to `other` lies outside the line, up to the angle tolerance.
bool outside(const Surface& surface, Vec2 v, int other, Vec2 normal) {
  const Vec2 u = surface.position[at(other)] - v;
  const double along = dot(normal, u);
  return along >= 0.0 || along * along <= Tolerances::sine_inside * Tolerances::sine_inside * squared_norm(u);
}

/// Length over [0, edge_length] that the edge of the vertex towards `other` shares with an edge it faces.
double shared_length(const Surface& surface, Vec2 v, int other, Vec2 a, Vec2 normal, Vec2 tangent,
                     double edge_length) {
  const Vec2 u = surface.position[at(other)] - v;
  const double across = dot(normal, u);
  if (across * across > Tolerances::sine_facing * Tolerances::sine_facing * squared_norm(u)) return 0.0;
  const double from = dot(v - a, tangent), to = from + dot(u, tangent);
  const double low = std::max(0.0, std::min(from, to)), high = std::min(edge_length, std::max(from, to));
  return std::max(0.0, high - low);
}

}  // namespace

bool Detection::evaluate(const Surface& surface, std::span<const double> reach, int candidate,
                         const Candidate& c, Contact& contact, Member& member) const {
  const int end = surface.next[at(c.edge)];
  const Vec2 a = surface.position[at(c.edge)], b = surface.position[at(end)],
             v = surface.position[at(c.vertex)];
  const double length = norm(b - a);
  const Vec2 tangent = (b - a) / length, normal{tangent.y, -tangent.x};
  const double gap = dot(normal, v - a), along = dot(tangent, v - a);
  const int block_a = surface.block[at(c.vertex)], block_b = surface.block[at(c.edge)];
  const double motion = reach[at(block_a)] + reach[at(block_b)];
  if (!c.memory.bonded && gap > tolerances_.activation + motion) return false;
  const double deepest =
      std::min({tolerances_.depth_limit, surface.thickness[at(block_a)], surface.thickness[at(block_b)]});
  if (gap < -deepest) return false;
  const double zone = std::min(tolerances_.end_zone + motion, 0.5 * length);
  const double before = surface.reflex[at(c.edge)] ? std::max(deepest, zone) : zone;
  const double after = surface.reflex[at(end)] ? std::max(deepest, zone) : zone;
  if (along < -before || along > length + after) return false;
  if (!outside(surface, v, surface.previous[at(c.vertex)], normal) ||
      !outside(surface, v, surface.next[at(c.vertex)], normal))
    return false;

  contact = {};
  contact.candidate = candidate;
  contact.block_a = block_a;
  contact.block_b = block_b;
  contact.vertex = c.vertex;
  contact.edge = c.edge;
  contact.normal = normal;
  contact.tangent = tangent;
  contact.position = along / length;
  contact.gap = gap;
  contact.length =
      0.5 * (shared_length(surface, v, surface.previous[at(c.vertex)], a, normal, tangent, length) +
             shared_length(surface, v, surface.next[at(c.vertex)], a, normal, tangent, length));

  const int corner = along < 0.5 * length ? c.edge : end;
  const double inside = std::min(along, length - along);
  member = {-1, -1, 0, inside};
  if (inside < zone && !surface.reflex[at(corner)]) {
    member.low = std::min(c.vertex, corner);
    member.high = std::max(c.vertex, corner);
  }
  return true;
}

void Detection::find(const Surface& surface, std::span<const double> reach,
                     std::vector<Candidate>& candidates, std::vector<Contact>& contacts) {
  found_.clear();
  members_.clear();
  Contact contact;
  Member member{};
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (!evaluate(surface, reach, static_cast<int>(k), candidates[k], contact, member)) {
      candidates[k].memory.tracked = false;
      candidates[k].memory.state = State::open;
      candidates[k].memory.bonded = false;
      continue;
    }
    if (member.low >= 0) {
      member.index = static_cast<int>(found_.size());
      members_.push_back(member);
    }
    found_.push_back(contact);
  }
  std::sort(members_.begin(), members_.end(), [](const Member& x, const Member& y) {
    return std::tie(x.low, x.high, x.index) < std::tie(y.low, y.high, y.index);
  });
  drop_.assign(found_.size(), 0);
  for (std::size_t first = 0; first < members_.size();) {
    std::size_t last = first + 1;
    while (last < members_.size() && members_[last].low == members_[first].low &&
           members_[last].high == members_[first].high)
      ++last;
    compete(std::span(members_).subspan(first, last - first), candidates);
    first = last;
  }
  contacts.clear();
  for (std::size_t k = 0; k < found_.size(); ++k) {
    Memory& memory = candidates[at(found_[k].candidate)].memory;
    if (drop_[k]) {
      const double slip = memory.slip;
      memory = {};
      memory.slip = slip;
      continue;
    }
    if (!memory.tracked) {
      memory.tracked = true;
      memory.offset = std::max(0.0, -found_[k].gap);
      memory.shear = memory.stiffness = memory.stored = memory.multiplier = memory.drift = 0.0;
      memory.normal_force = memory.bounding_force = 0.0;
      memory.state = State::open;
    } else if (memory.offset > 0.0) {
      memory.offset = std::min(memory.offset, std::max(0.0, -found_[k].gap));
    }
    complete(surface, memory, found_[k]);
    contacts.push_back(found_[k]);
  }
}

void Detection::compete(std::span<const Member> members, std::vector<Candidate>& candidates) {
  const auto contact = [&](const Member& m) -> Contact& { return found_[at(m.index)]; };
  const auto memory = [&](const Member& m) -> Memory& { return candidates[at(contact(m).candidate)].memory; };
  const bool parallel = std::all_of(members.begin(), members.end(), [&](const Member& m) {
    return std::abs(cross(contact(m).tangent, contact(members[0]).tangent)) < Tolerances::sine_parallel;
  });
  const Member* holder = nullptr;  // the one that was in contact; the strongest, should there be several
  for (const Member& m : members) {
    if (memory(m).tracked && (holder == nullptr || memory(m).normal_force > memory(*holder).normal_force))
      holder = &m;
  }
  const Member* winner = nullptr;
  if (parallel) {
    for (const Member& m : members) {
      if (winner == nullptr || m.inside > winner->inside) winner = &m;
    }
    const double leave = -0.5 * tolerances_.end_zone;
    if (holder != nullptr && (holder->inside > leave || winner->inside < -tolerances_.rounding))
      winner = holder;
    if (holder == nullptr && winner->inside < -tolerances_.rounding) {
      winner = nullptr;  // a vertex beyond the end of an edge, with nothing of it on the other side
    }
  } else {
    for (const Member& m : members) {
      if (winner == nullptr || contact(m).gap > contact(*winner).gap) winner = &m;
    }
    double second = -HUGE_VAL;
    for (const Member& m : members) {
      if (std::abs(cross(contact(m).tangent, contact(*winner).tangent)) >= Tolerances::sine_parallel) {
        second = std::max(second, contact(m).gap);
      }
    }
    const double best = contact(*winner).gap;
    if (best > -tolerances_.corner_depth && best - second < tolerances_.corner_tie) winner = nullptr;
  }
  if (winner != nullptr && holder != nullptr && winner != holder && parallel) {
    const double slip = memory(*winner).slip;
    memory(*winner) = memory(*holder);
    memory(*winner).slip += slip;
    // The tangents of the two lines run against each other when the vertex and the edge change sides; slip of the one
    // block against the other has the same sign on both sides, as normal and tangent turn together.
  }
  for (const Member& m : members) {
    if (&m != winner) drop_[at(m.index)] = 1;
  }
}

namespace {

/// The stiffness of a contact goes with the joint that belongs to it, and jumps when an edge comes to lie flat. Its elastic
/// energy stays what it was: penetration that the new spring would turn into energy nobody spent goes to the offset, and
/// comes back from there when the joint gets shorter again.
void keep_energy(Memory& memory, double gap, double stiffness) {
  const double depth = -gap - memory.offset;
  if (memory.multiplier > 0.0) {  // a force that belongs to no penetration stays
    memory.multiplier *= memory.stiffness / stiffness;
    memory.shear *= memory.stiffness / stiffness;
  } else if (memory.stiffness > 0.0 && stiffness != memory.stiffness && depth > 0.0) {
    const double scale = std::sqrt(memory.stiffness / stiffness);
    memory.offset = std::max(-gap - scale * depth, std::min(memory.offset, 0.0));
    memory.shear *= scale;
  }
  memory.stiffness = stiffness;
}

}  // namespace

void Detection::complete(const Surface& surface, Memory& memory, Contact& contact) const {
  const JointLaw& law = laws_[at(surface.joint[at(contact.edge)])];
  const double per_length = law.normal_stiffness > 0.0
                                ? law.normal_stiffness
                                : std::min(penalty_[at(contact.block_a)], penalty_[at(contact.block_b)]);
  contact.normal_stiffness = per_length * std::max(contact.length, tolerances_.least_length);
  contact.shear_stiffness = law.stiffness_ratio * contact.normal_stiffness;
  contact.friction_coefficient = law.friction_coefficient;
  if (memory.bonded) {
    contact.cohesion = law.cohesion * contact.length;
    contact.tension = law.tension * contact.length;
    contact.fused = law.fused;
  }
  keep_energy(memory, contact.gap, contact.normal_stiffness);
  contact.depth = -contact.gap - memory.offset + memory.multiplier;
}

}  // namespace keyblock::contact
