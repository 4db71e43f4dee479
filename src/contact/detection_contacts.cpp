// What is known of a contact, once it is one.
#include <algorithm>
#include <array>
#include <cmath>

#include "contact/contact_lanes.h"
#include "contact/detection.h"
#include "contact/edge_curve.h"
#include "contact/shared_length.h"
#include "core/index.h"

namespace keyblock::contact {

namespace {

/// The stiffness of a contact goes with the joint that belongs to it, and jumps when an edge comes to lie flat. Its elastic
/// energy stays what it was: penetration that the new spring would turn into energy nobody spent goes to the offset, and
/// comes back from there when the joint gets shorter again. What it has no room for is lost by a spring that gets softer.
void keep_energy(MemoryLanes& memory, Lanes gap, Lanes stiffness) {
  const Lanes zero{}, depth = -gap - memory.offset, ratio = memory.stiffness / stiffness;
  const auto pushes = memory.multiplier > 0.0;  // a force that belongs to no penetration stays
  const auto is_other = (stiffness < memory.stiffness) | (stiffness > memory.stiffness),
             changes = ~pushes & (memory.stiffness > 0.0) & is_other & (depth > 0.0);
  const Lanes scale = square_root(ratio), wanted = scale * depth,
              offset = largest(-gap - wanted, least(memory.offset, zero)), now = -gap - offset;
  memory.stored = where(changes & (now < wanted),
                        memory.stored - 0.5 * stiffness * (wanted * wanted - now * now), memory.stored);
  memory.offset = where(changes, offset, memory.offset);
  memory.multiplier = where(pushes, memory.multiplier * ratio, memory.multiplier);
  memory.shear = where(pushes, memory.shear * ratio, where(changes, memory.shear * scale, memory.shear));
  memory.stiffness = stiffness;
}

}  // namespace

/// Eight at once, or fewer at the end. Where no edge is divided, each vertex has the half of what edges have in common.
template <bool divided>
Detection::Geometry Detection::measure(const Surface& surface, const CandidateList& candidates,
                                       std::span<const Found> found) const {
  Lanes edge[lane_count], vertex[lane_count], length_before{}, at_corner{};
  std::array<std::size_t, lane_count> edges{}, after{}, before{};  // those of the vertex begin and end there
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Found& f = found[i < found.size() ? i : 0];
    const Candidate& c = candidates.pairs[at(f.candidate)];
    edges[i] = at(c.edge);
    after[i] = at(c.vertex);
    before[i] = at(surface.previous[at(c.vertex)]);
    edge[i] = load(&corners_[edges[i]].position.x);
    vertex[i] = load(&corners_[after[i]].position.x);
    length_before[i] = corners_[before[i]].length;
    at_corner[i] = f.at_end ? 1.0 : 0.0;
  }
  transpose(edge);
  transpose(vertex);
  const Lanes tx = edge[2], ty = edge[3], nx = ty, ny = -tx, length = edge[6];
  const Lanes dx = vertex[0] - edge[0], dy = vertex[1] - edge[1];
  const Lanes gap = nx * dx + ny * dy, along = tx * dx + ty * dy;
  const auto look_at = [&](const std::array<std::size_t, lane_count>& of) -> Beside<Lanes> {
    if constexpr (!divided) return {broadcast(0.5), Lanes{}, Lanes{}, broadcast(1.0)};
    Lanes w[lane_count];
    for (std::size_t i = 0; i < lane_count; ++i) w[i] = load(&wholes_[of[i]].from.x);
    transpose(w);
    return {w[4], tx * (w[0] - edge[0]) + ty * (w[1] - edge[1]),
            tx * (w[2] - edge[0]) + ty * (w[3] - edge[1]), w[5]};
  };
  const Beside<Lanes> here = look_at(edges), next = look_at(after), last = look_at(before);
  const SharedLength<Lanes> shared{along, length, tolerances_.end_zone, tolerances_.activation};
  const Lanes most = broadcast(tolerances_.least_length);
  Lanes shared_length{}, whole_length{};
  auto shares_much = whole_length > 0.0, faces = shares_much;
  // With an edge of the vertex, of direction u, where they face each other: they run against each other, both with their block on the left.
  const auto add_edge = [&](Lanes ux, Lanes uy, Lanes length_of_other, Lanes sign, const Beside<Lanes>& other,
                            const Beside<Lanes>& this_edge) {
    const Lanes across = nx * ux + ny * uy, ahead = ux * tx + uy * ty, long_beside = shared.stretch(across);
    const auto turned = (ahead > 0.0) | (across * across > Tolerances::sine_facing * Tolerances::sine_facing);
    const Lanes to = along + ahead * sign * length_of_other;
    const Lanes of_vertex = divided ? shared(to, long_beside, other, this_edge)
                                    : 0.5 * shared.common(to, long_beside),
                common = where(turned, Lanes{}, of_vertex);
    shared_length += common;
    faces = faces | ~turned;
    whole_length =
        largest(whole_length, where((common > tolerances_.rounding) | (~turned & (at_corner > 0.0)),
                                    least(other.share * length_of_other, this_edge.share * length), Lanes{}));
    if (!divided) return;  // what has that length in common gives each vertex more than the least
    const Lanes overlap = least(largest(other.from, other.to), this_edge.to) -
                          largest(least(other.from, other.to), this_edge.from);
    shares_much = shares_much | (~turned & (least(overlap, long_beside) >= 2.0 * most));
  };
  add_edge(vertex[2], vertex[3], vertex[6], broadcast(1.0), next, at_end(here));
  add_edge(vertex[4], vertex[5], length_before, broadcast(-1.0), at_end(last), here);
  // One that faces the edge and shares nothing of it, not even where two corners meet, is held by the edge beside.
  const auto is_one_of_many = shares_much | (faces & ~(whole_length > 0.0));
  const Lanes enough = where(is_one_of_many, Tolerances::least_of_many * most, most);
  return {gap, along / length, shared_length, where(whole_length > 0.0, least(whole_length, enough), enough)};
}

/// What the contact of two corners has of the edge on the other side of the corner, where face goes on in face: edges of blocks of
/// order > 1 are divided at the same points on both sides of a joint, and of the contacts of the two vertices that meet there one is
/// left. position: Contact::position.
Detection::Beyond Detection::beyond_end(const Surface& surface, const Candidate& candidate,
                                        double position) const {
  const std::size_t next = at(candidate.vertex), before = at(surface.previous[next]),
                    beyond = at(position < 0.5 ? surface.previous[at(candidate.edge)]
                                               : surface.next[at(candidate.edge)]);
  const Corner &vertex = corners_[next], &edge = corners_[at(candidate.edge)], &line = corners_[beyond];
  if (dot(edge.tangent, line.tangent) < 0.0 ||
      std::abs(cross(edge.tangent, line.tangent)) > Tolerances::sine_facing)
    return {};
  const auto look_at = [&](std::size_t e) -> Beside<double> {
    if (wholes_.empty()) return {0.5, 0.0, 0.0, 1.0};
    const Whole& whole = wholes_[e];
    const auto along = [&](Vec2 end) { return dot(line.tangent, end - line.position); };
    return {whole.start_share, along(whole.from), along(whole.to), whole.pieces};
  };
  const Beside<double> here = look_at(beyond);
  const double along = dot(line.tangent, vertex.position - line.position);
  const SharedLength<double> shared{along, line.length, tolerances_.end_zone, tolerances_.activation};
  const auto of_edge = [&](Vec2 u, double length_of_other, const Beside<double>& other,
                           const Beside<double>& this_edge) {
    const double ahead = dot(u, line.tangent), across = cross(u, line.tangent);
    if (ahead > 0.0 || std::abs(across) > Tolerances::sine_facing) return 0.0;
    const double to = along + ahead * length_of_other, long_beside = shared.stretch(across);
    return wholes_.empty() ? 0.5 * shared.common(to, long_beside) : shared(to, long_beside, other, this_edge);
  };
  const double length = of_edge(vertex.tangent, vertex.length, look_at(next), at_end(here)) +
                        of_edge(vertex.before, -corners_[before].length, at_end(look_at(before)), here);
  return {length, 0.0, surface.joint[beyond]};
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

/// The law of an edge and of the one beyond its end, which has `share` of what belongs to the contact. What is fused is so to its end.
JointLaw Detection::law_over_corner(JointLaw law, const JointLaw& beyond, double share, double penalty) {
  const auto stiffness = [&](const JointLaw& of) {
    return of.normal_stiffness > 0.0 ? of.normal_stiffness : penalty;
  };
  const double normal = std::lerp(stiffness(law), stiffness(beyond), share),
               shear = std::lerp(stiffness(law) * law.stiffness_ratio,
                                 stiffness(beyond) * beyond.stiffness_ratio, share);
  law.friction_coefficient = std::lerp(law.friction_coefficient, beyond.friction_coefficient, share);
  law.cohesion = std::lerp(law.cohesion, beyond.cohesion, share);
  law.tension = std::lerp(law.tension, beyond.tension, share);
  law.normal_stiffness = normal;
  law.stiffness_ratio = shear / normal;
  return law;
}

/// Of a contact that knows its blocks and whether it is bonded. Written in place: numbers that are stored one by one cannot be copied together
/// at once.
void Detection::find_law(const Surface& surface, const Contact& contact, const Beyond& beyond,
                         SpringLaw& of_contact) const {
  const double penalty = std::min(penalty_[at(contact.block_a)], penalty_[at(contact.block_b)]);
  const std::size_t joint = at(surface.joint[at(contact.edge)]);
  const bool mixed = beyond.share > 0.0 && laws_[at(beyond.joint)] != laws_[joint];
  const JointLaw over_corner =
      mixed ? law_over_corner(laws_[joint], laws_[at(beyond.joint)], beyond.share, penalty) : JointLaw{};
  const JointLaw& law = mixed ? over_corner : laws_[joint];
  const bool bonded = contact.memory.bonded;
  const double of_joint = law.normal_stiffness > 0.0 ? law.normal_stiffness : penalty;
  of_contact.fused = bonded && law.fused;
  of_contact.per_length = of_contact.fused ? std::max(of_joint, penalty) : of_joint;
  of_contact.stiffness_ratio = law.stiffness_ratio;
  of_contact.friction = law.friction_coefficient;
  of_contact.cohesion = bonded ? law.cohesion : 0.0;
  of_contact.tension = bonded ? law.tension : 0.0;
}

/// Which blocks meet where.
void Detection::identify(const Found& found, const Candidate& candidate, Contact& contact) const {
  contact.candidate = found.candidate;
  contact.block_a = candidate.block_a;
  contact.block_b = candidate.block_b;
  contact.vertex = candidate.vertex;
  contact.edge = candidate.edge;
  contact.normal = corners_[at(candidate.edge)].normal();
}

/// As many as there are lanes, or fewer.
void Detection::describe_some(const Surface& surface, const CandidateList& candidates,
                              std::span<const Found> found, std::span<Contact> contacts) const {
  static constexpr Memory nothing;
  const auto before = [&](const Found& f) -> const Memory& {
    return f.memory < 0 ? nothing : candidates.memory[at(f.memory)];
  };
  const Geometry geometry = wholes_.empty() ? measure<false>(surface, candidates, found)
                                            : measure<true>(surface, candidates, found);
  std::array<SpringLaw, lane_count> laws;
  LawLanes law{};
  law.gap = geometry.gap;
  law.length = geometry.length;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Candidate& candidate = candidates.pairs[at(found[i].candidate)];
    Contact& contact = contacts[i];
    identify(found[i], candidate, contact);
    contact.position = geometry.position[i];
    if (is_curved(surface, contact.edge)) {
      contact.gap = geometry.gap[i];
      bend(surface, contact);
      law.gap[i] = contact.gap;
    }
    Beyond beyond = found[i].at_end ? beyond_end(surface, candidate, contact.position) : Beyond{};
    if (beyond.length > 0.0) {
      law.length[i] += beyond.length;
      beyond.share = beyond.length / law.length[i];
    }
    const Memory& memory = before(found[i]);
    contact.memory.state = memory.state;
    contact.memory.bonded = memory.bonded;
    contact.memory.bond_length = memory.bond_length;
    if (memory.bonded) law.length[i] = memory.bond_length;
    find_law(surface, contact, beyond, laws[i]);
    contact.fused = laws[i].fused;
  }
  const std::span<const SpringLaw> of_joints = std::span(laws).first(contacts.size());
  const auto of_joint = [&](double SpringLaw::*number) {
    return lanes_of(of_joints, [&](const SpringLaw& one) { return one.*number; });
  };
  law.normal_stiffness = of_joint(&SpringLaw::per_length) * largest(law.length, geometry.least_length);
  law.shear_stiffness = of_joint(&SpringLaw::stiffness_ratio) * law.normal_stiffness;
  law.friction = of_joint(&SpringLaw::friction);
  law.cohesion = of_joint(&SpringLaw::cohesion) * law.length;
  law.tension = of_joint(&SpringLaw::tension) * law.length;
  MemoryLanes memory = components_of<MemoryLanes>(found, [&](const Found& f) { return &before(f).offset; });
  const auto is_new = lanes_where(found, [](const Found& f) { return f.memory < 0; });
  const Lanes zero{}, born = largest(zero, -law.gap);
  memory.offset = where(is_new, born, where(memory.offset > 0.0, least(memory.offset, born), memory.offset));
  keep_energy(memory, law.gap, law.normal_stiffness);
  law.depth = -law.gap - memory.offset + memory.multiplier;
  keep(law, contacts);
  keep(memory, contacts);
}

void Detection::describe(const Surface& surface, const CandidateList& candidates,
                         std::span<const Found> found, std::span<Contact> contacts) const {
  for (std::size_t begin = 0; begin < found.size(); begin += lane_count) {
    const std::size_t count = std::min(found.size() - begin, std::size_t{lane_count});
    describe_some(surface, candidates, found.subspan(begin, count), contacts.subspan(begin, count));
  }
}

void keep_memory(std::span<const Contact> contacts, std::size_t first, std::size_t last,
                 CandidateList& candidates) {
  for (std::size_t k = first; k < last; ++k) {
    const Contact& c = contacts[k];
    candidates.tracked[k] = c.candidate;
    candidates.memory[k] = c.memory;
    if (c.memory.bonded) candidates.pairs[at(c.candidate)].clearance = 0.0;  // any gap is a contact
  }
}

void keep_memory(std::span<const Contact> contacts, CandidateList& candidates, ThreadTeam& team) {
  candidates.make_room(contacts.size());
  team.for_range(contacts.size(), contacts_worth_threads,
                 [&](std::size_t begin, std::size_t end) { keep_memory(contacts, begin, end, candidates); });
}

}  // namespace keyblock::contact
