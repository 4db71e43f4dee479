// What is known of a contact, once it is one.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "contact/detection.h"
#include "contact/edge_curve.h"
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

/// Of lanes, or of one number each.
template <typename Number>
struct SharedLength {
  Number along, length;  ///< m: of the edge, where the vertex is on it and how long it is
  double zone;           ///< m, by which edges may miss each other and still begin or end together

  /// m that the vertex has of what an edge of its block, that goes on to `to`, has in common with this one. Where that edge or this is all
  /// of it the share is what Surface::start_share gives it of the one or the other, or of both.
  Number operator()(Number to, Number share_of_other, Number share_of_this) const {
    const Number low = smaller(along, to), high = larger(along, to), zero{};
    const Number common = larger(zero, smaller(length, high) - larger(zero, low));
    const auto is_all_of_other = (low >= -zone) & (high <= length + zone),
               is_all_of_this = (low <= zone) & (high >= length - zone);
    const Number half = zero + 0.5, both = 0.5 * (share_of_other + share_of_this);
    return common * where(is_all_of_other, where(is_all_of_this, both, share_of_other),
                          where(is_all_of_this, share_of_this, half));
  }

 private:
  static Number smaller(Number a, Number b) { return where(b < a, b, a); }
  static Number larger(Number a, Number b) { return where(a < b, b, a); }
};

}  // namespace

/// Eight at once, or fewer at the end.
Detection::Geometry Detection::measure(const Surface& surface, const CandidateList& candidates,
                                       std::span<const Found> found) const {
  Lanes edge[lane_count], vertex[lane_count], length_before{};
  Lanes share_of_edge = broadcast(0.5), share_of_next = share_of_edge, share_of_before = share_of_edge;
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Candidate& c = candidates.pairs[at(found[i < found.size() ? i : 0].candidate)];
    const std::size_t before = at(surface.previous[at(c.vertex)]);
    edge[i] = load(&corners_[at(c.edge)].position.x);
    vertex[i] = load(&corners_[at(c.vertex)].position.x);
    length_before[i] = corners_[before].length;
    if (surface.start_share.empty()) continue;
    share_of_edge[i] = surface.start_share[at(c.edge)];
    share_of_next[i] = surface.start_share[at(c.vertex)];
    share_of_before[i] = surface.start_share[before];
  }
  transpose(edge);
  transpose(vertex);
  const Lanes tx = edge[2], ty = edge[3], nx = ty, ny = -tx, length = edge[6];
  const Lanes dx = vertex[0] - edge[0], dy = vertex[1] - edge[1];
  const Lanes gap = nx * dx + ny * dy, along = tx * dx + ty * dy;
  const SharedLength<Lanes> shared{along, length, tolerances_.end_zone};
  // With an edge of the vertex, of direction u, where they face each other: they run against each other, both with their block on the left.
  Lanes shared_length{}, whole_length{};
  const auto add_edge = [&](Lanes ux, Lanes uy, Lanes length_of_other, Lanes sign, Lanes share_of_other,
                            Lanes share_of_this) {
    const Lanes across = nx * ux + ny * uy, ahead = ux * tx + uy * ty;
    const auto turned = (ahead > 0.0) | (across * across > Tolerances::sine_facing * Tolerances::sine_facing);
    shared_length +=
        where(turned, Lanes{}, shared(along + ahead * sign * length_of_other, share_of_other, share_of_this));
    whole_length += where(turned, Lanes{}, least(share_of_other * length_of_other, share_of_this * length));
  };
  add_edge(vertex[2], vertex[3], vertex[6], broadcast(1.0), share_of_next, 1.0 - share_of_edge);
  add_edge(vertex[4], vertex[5], length_before, broadcast(-1.0), 1.0 - share_of_before, share_of_edge);
  const Lanes most = broadcast(tolerances_.least_length);
  return {gap, along / length, shared_length, where(whole_length > 0.0, least(whole_length, most), most)};
}

/// m, what the contact of two corners has of the edge on the other side of the corner, where face goes on in face: edges of blocks of
/// order > 1 are divided at the same points on both sides of a joint, and of the contacts of the two vertices that meet there one is
/// left. position: Contact::position.
double Detection::length_beyond(const Surface& surface, const Candidate& candidate, double position) const {
  const std::size_t next = at(candidate.vertex), before = at(surface.previous[next]),
                    beyond = at(position < 0.5 ? surface.previous[at(candidate.edge)]
                                               : surface.next[at(candidate.edge)]);
  const Corner &vertex = corners_[next], &edge = corners_[at(candidate.edge)], &line = corners_[beyond];
  if (dot(edge.tangent, line.tangent) < 0.0 ||
      std::abs(cross(edge.tangent, line.tangent)) > Tolerances::sine_facing)
    return 0.0;
  const auto share_of = [&](std::size_t e) {
    return surface.start_share.empty() ? 0.5 : surface.start_share[e];
  };
  const double along = dot(line.tangent, vertex.position - line.position);
  const SharedLength<double> shared{along, line.length, tolerances_.end_zone};
  const auto of_edge = [&](Vec2 u, double length_of_other, double share_of_other, double share_of_this) {
    const double ahead = dot(u, line.tangent);
    if (ahead > 0.0 || std::abs(cross(u, line.tangent)) > Tolerances::sine_facing) return 0.0;
    return shared(along + ahead * length_of_other, share_of_other, share_of_this);
  };
  return of_edge(vertex.tangent, vertex.length, share_of(next), 1.0 - share_of(beyond)) +
         of_edge(vertex.before, -corners_[before].length, 1.0 - share_of(before), share_of(beyond));
}

/// Brings a contact from the chord of a piece of a divided edge to its curve: to the point that the vertex is opposite to.
void Detection::bend(const Surface& surface, Contact& contact) {
  const Vec2 from = surface.position[at(contact.edge)],
             to = surface.position[at(surface.next[at(contact.edge)])];
  const auto from_curve = [&](double position) {
    Vec2 apart = surface.position[at(contact.vertex)];
    for_curve_vertices(surface, contact.edge, position,
                       [&](std::size_t v, double share) { apart -= share * surface.position[v]; });
    return apart;
  };
  contact.position += dot(contact.tangent(), from_curve(contact.position)) / norm(to - from);
  contact.gap = dot(contact.normal, from_curve(contact.position));
}

void Detection::give_law(const Surface& surface, Contact& contact, double least_length) const {
  const JointLaw& law = laws_[at(surface.joint[at(contact.edge)])];
  const double per_length = law.normal_stiffness > 0.0
                                ? law.normal_stiffness
                                : std::min(penalty_[at(contact.block_a)], penalty_[at(contact.block_b)]);
  contact.normal_stiffness = per_length * std::max(contact.length, least_length);
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
      if (is_curved(surface, contact.edge)) bend(surface, contact);
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
      give_law(surface, contact, geometry.least_length[i]);
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
