// What is known of a contact, once it is one.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "contact/detection.h"
#include "core/index.h"

namespace keyblock::contact {

namespace {

/// The stiffness of a contact goes with the joint that belongs to it, and jumps when an edge comes to lie flat. Its elastic
/// energy stays what it was: penetration that the new spring would turn into energy nobody spent goes to the offset, and
/// comes back from there when the joint gets shorter again. What it has no room for is lost by a spring that gets softer.
void keep_energy(Memory& memory, double gap, double stiffness) {
  const double depth = -gap - memory.offset;
  if (memory.multiplier > 0.0) {  // a force that belongs to no penetration stays
    memory.multiplier *= memory.stiffness / stiffness;
    memory.shear *= memory.stiffness / stiffness;
  } else if (memory.stiffness > 0.0 && stiffness != memory.stiffness && depth > 0.0) {
    const double scale = std::sqrt(memory.stiffness / stiffness), wanted = scale * depth;
    memory.offset = std::max(-gap - wanted, std::min(memory.offset, 0.0));
    memory.shear *= scale;
    const double now = -gap - memory.offset;
    if (now < wanted) memory.stored -= 0.5 * stiffness * (wanted * wanted - now * now);
  }
  memory.stiffness = stiffness;
}

}  // namespace

/// Eight at once, or fewer at the end.
Detection::Geometry Detection::measure(const Surface& surface, const CandidateList& candidates,
                                       std::span<const Found> found) const {
  Lanes edge[lane_count], vertex[lane_count], length_before{};
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Candidate& c = candidates.pairs[at(found[i < found.size() ? i : 0].candidate)];
    edge[i] = load(&corners_[at(c.edge)].position.x);
    vertex[i] = load(&corners_[at(c.vertex)].position.x);
    length_before[i] = corners_[at(surface.previous[at(c.vertex)])].length;
  }
  transpose(edge);
  transpose(vertex);
  const Lanes tx = edge[2], ty = edge[3], nx = ty, ny = -tx, length = edge[6];
  const Lanes dx = vertex[0] - edge[0], dy = vertex[1] - edge[1];
  const Lanes gap = nx * dx + ny * dy, along = tx * dx + ty * dy;
  // Length over the edge that an edge of the vertex, of direction u, shares with it, where they face each other: they run against each
  // other, both with their block on the left.
  const auto shared = [&](Lanes ux, Lanes uy, Lanes length_of_other) {
    const Lanes across = nx * ux + ny * uy, ahead = ux * tx + uy * ty, to = along + ahead * length_of_other;
    const Lanes low = largest(Lanes{}, least(along, to)), high = least(length, largest(along, to));
    const auto turned = (ahead > 0.0) | (across * across > Tolerances::sine_facing * Tolerances::sine_facing);
    return where(turned, Lanes{}, largest(Lanes{}, high - low));
  };
  return {gap, along / length,
          0.5 * (shared(vertex[2], vertex[3], vertex[6]) + shared(vertex[4], vertex[5], -length_before))};
}

/// m, what the contact of two corners has of the edge on the other side of the corner, where face goes on in face: edges of blocks of
/// order > 1 are divided at the same points on both sides of a joint, and of the contacts of the two vertices that meet there one is
/// left. position: Contact::position.
double Detection::length_beyond(const Surface& surface, const Candidate& candidate, double position) const {
  const Corner &vertex = corners_[at(candidate.vertex)], &edge = corners_[at(candidate.edge)];
  const Corner& line =
      corners_[at(position < 0.5 ? surface.previous[at(candidate.edge)] : surface.next[at(candidate.edge)])];
  if (dot(edge.tangent, line.tangent) < 0.0 ||
      std::abs(cross(edge.tangent, line.tangent)) > Tolerances::sine_facing)
    return 0.0;
  const double along = dot(line.tangent, vertex.position - line.position);
  const auto shared = [&](Vec2 u, double length_of_other) {
    const double ahead = dot(u, line.tangent), to = along + ahead * length_of_other;
    if (ahead > 0.0 || std::abs(cross(u, line.tangent)) > Tolerances::sine_facing) return 0.0;
    return std::max(0.0, std::min(line.length, std::max(along, to)) - std::max(0.0, std::min(along, to)));
  };
  return 0.5 * (shared(vertex.tangent, vertex.length) +
                shared(vertex.before, -corners_[at(surface.previous[at(candidate.vertex)])].length));
}

void Detection::give_law(const Surface& surface, Contact& contact) const {
  const JointLaw& law = laws_[at(surface.joint[at(contact.edge)])];
  const double per_length = law.normal_stiffness > 0.0
                                ? law.normal_stiffness
                                : std::min(penalty_[at(contact.block_a)], penalty_[at(contact.block_b)]);
  contact.normal_stiffness = per_length * std::max(contact.length, tolerances_.least_length);
  contact.shear_stiffness = law.stiffness_ratio * contact.normal_stiffness;
  contact.friction_coefficient = law.friction_coefficient;
  contact.cohesion = contact.memory.bonded ? law.cohesion * contact.length : 0.0;
  contact.tension = contact.memory.bonded ? law.tension * contact.length : 0.0;
  contact.fused = contact.memory.bonded && law.fused;
}

void Detection::describe(const Surface& surface, const CandidateList& candidates,
                         std::span<const Found> found, std::span<Contact> contacts) const {
  for (std::size_t begin = 0; begin < found.size(); begin += lane_count) {
    const std::size_t count = std::min(found.size() - begin, std::size_t{lane_count});
    const Geometry geometry = measure(surface, candidates, found.subspan(begin, count));
    for (std::size_t i = 0; i < count; ++i) {
      const Found& f = found[begin + i];
      const Candidate& candidate = candidates.pairs[at(f.candidate)];
      Contact& contact = contacts[begin + i];
      contact.candidate = f.candidate;
      contact.block_a = candidate.block_a;
      contact.block_b = candidate.block_b;
      contact.vertex = candidate.vertex;
      contact.edge = candidate.edge;
      contact.normal = corners_[at(candidate.edge)].normal();
      contact.position = geometry.position[i];
      contact.gap = geometry.gap[i];
      contact.length = geometry.length[i];
      if (f.at_end) contact.length += length_beyond(surface, candidate, contact.position);
      Memory& memory = contact.memory;
      if (f.memory < 0) {
        memory = {};
        memory.offset = std::max(0.0, -contact.gap);
      } else {
        memory = candidates.memory[at(f.memory)];
        if (memory.offset > 0.0) memory.offset = std::min(memory.offset, std::max(0.0, -contact.gap));
      }
      give_law(surface, contact);
      keep_energy(memory, contact.gap, contact.normal_stiffness);
      contact.depth = -contact.gap - memory.offset + memory.multiplier;
    }
  }
}

bool keep_memory(std::span<const Contact> contacts, std::size_t first, std::size_t last,
                 CandidateList& candidates) {
  bool any_bond = false;
  for (std::size_t k = first; k < last; ++k) {
    const Contact& c = contacts[k];
    candidates.tracked[k] = c.candidate;
    candidates.memory[k] = c.memory;
    if (!c.memory.bonded) continue;
    candidates.pairs[at(c.candidate)].clearance = 0.0;  // of a bond, any gap is a contact
    any_bond = true;
  }
  return any_bond;
}

void keep_memory(std::span<const Contact> contacts, CandidateList& candidates, ThreadTeam& team) {
  candidates.make_room(contacts.size());
  std::atomic<bool> any_bond = false;
  team.for_range(contacts.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    if (keep_memory(contacts, begin, end, candidates)) any_bond = true;
  });
  candidates.may_have_bonds = any_bond;
}

}  // namespace keyblock::contact
