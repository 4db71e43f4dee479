// What is known of a contact, once it is one.
#include <algorithm>
#include <array>
#include <atomic>
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

/// Some vertices, as many as there are lanes, and what their edges have in common with a line each.
struct Detection::Vertices {
  Lanes corner[lane_count];                          ///< components of Corner
  Lanes length_before;                               ///< m, of the edge that ends there
  std::array<std::size_t, lane_count> next, before;  ///< the edges that begin and end there

  /// One of their edges, where it faces the line: they run against each other, both with their block on the left.
  struct Facing {
    LaneCondition faces;
    Lanes common;       ///< m of the line that the vertex has of what both share; 0 where it does not face
    Lanes long_beside;  ///< m
    Lanes length;       ///< m, of the edge of the vertex
    Beside<Lanes> edge, line;  ///< at the end that the vertex is nearer to
  };
};

/// Calls of_edge(facing) for both edges of the vertices. line: components of Corner. Where no edge is divided, each vertex has the half of
/// what edges have in common.
template <bool divided, typename OfEdge>
void Detection::for_facing(const Vertices& vertices, const Lanes (&line)[lane_count],
                           const std::array<std::size_t, lane_count>& lines, const OfEdge& of_edge) const {
  const Lanes(&vertex)[lane_count] = vertices.corner;
  const Lanes tx = line[2], ty = line[3], along = tx * (vertex[0] - line[0]) + ty * (vertex[1] - line[1]);
  const auto look_at = [&](const std::array<std::size_t, lane_count>& of) -> Beside<Lanes> {
    if constexpr (!divided) return {broadcast(0.5), Lanes{}, Lanes{}, broadcast(1.0)};
    Lanes w[lane_count];
    for (std::size_t i = 0; i < lane_count; ++i) w[i] = load(&wholes_[of[i]].from.x);
    transpose(w);
    return {w[4], tx * (w[0] - line[0]) + ty * (w[1] - line[1]),
            tx * (w[2] - line[0]) + ty * (w[3] - line[1]), w[5]};
  };
  const SharedLength<Lanes> shared{along, line[6], tolerances_.end_zone, tolerances_.activation};
  const auto look_at_edge = [&](Lanes ux, Lanes uy, Lanes length, Lanes sign, const Beside<Lanes>& edge,
                                const Beside<Lanes>& of_line) {
    const Lanes across = ty * ux - tx * uy, ahead = ux * tx + uy * ty, long_beside = shared.stretch(across);
    const auto faces =
        ~((ahead > 0.0) | (across * across > Tolerances::sine_facing * Tolerances::sine_facing));
    const Lanes to = along + ahead * sign * length;
    const Lanes of_vertex =
        divided ? shared(to, long_beside, edge, of_line) : 0.5 * shared.common(to, long_beside);
    of_edge(Vertices::Facing{faces, where(faces, of_vertex, Lanes{}), long_beside, length, edge, of_line});
  };
  const Beside<Lanes> here = look_at(lines);
  look_at_edge(vertex[2], vertex[3], vertex[6], broadcast(1.0), look_at(vertices.next), at_end(here));
  look_at_edge(vertex[4], vertex[5], vertices.length_before, broadcast(-1.0),
               at_end(look_at(vertices.before)), here);
}

/// Eight at once, or fewer at the end.
template <bool divided>
Detection::Geometry Detection::measure(const Surface& surface, const CandidateList& candidates,
                                       std::span<const Found> found) const {
  Vertices vertices;
  Lanes edge[lane_count];
  std::array<std::size_t, lane_count> edges;
  for (std::size_t i = 0; i < lane_count; ++i) {
    const Candidate& c = candidates.pairs[at(found[i < found.size() ? i : 0].candidate)];
    edges[i] = at(c.edge);
    vertices.next[i] = at(c.vertex);
    vertices.before[i] = at(surface.previous[at(c.vertex)]);
    edge[i] = load(&corners_[edges[i]].position.x);
    vertices.corner[i] = load(&corners_[vertices.next[i]].position.x);
  }
  transpose(edge);
  transpose(vertices.corner);
  vertices.length_before = each_lane([&](std::size_t i) { return corners_[vertices.before[i]].length; });
  const auto at_corner = lanes_where(found, [](const Found& f) { return f.at_end; });
  const Lanes dx = vertices.corner[0] - edge[0], dy = vertices.corner[1] - edge[1], length = edge[6],
              position = (edge[2] * dx + edge[3] * dy) / length, most = broadcast(tolerances_.least_length);
  Lanes shared_length{}, whole_length{};
  auto shares_much = whole_length > 0.0, any_faces = shares_much;
  for_facing<divided>(vertices, edge, edges, [&](const Vertices::Facing& f) {
    shared_length += f.common;
    any_faces = any_faces | f.faces;
    whole_length =
        largest(whole_length, where((f.common > tolerances_.rounding) | (f.faces & at_corner),
                                    least(f.edge.share * f.length, f.line.share * length), Lanes{}));
    if (!divided) return;  // what has that length in common gives each vertex more than the least
    const Lanes overlap = least(largest(f.edge.from, f.edge.to), f.line.to) -
                          largest(least(f.edge.from, f.edge.to), f.line.from);
    shares_much = shares_much | (f.faces & (least(overlap, f.long_beside) >= 2.0 * most));
  });
  // One that faces the edge and shares nothing of it, not even where two corners meet, is held by the edge beside.
  const auto is_one_of_many = shares_much | (any_faces & ~(whole_length > 0.0));
  const Lanes enough = where(is_one_of_many, Tolerances::least_of_many * most, most);
  Geometry geometry{edge[3] * dx - edge[2] * dy,
                    position,
                    shared_length,
                    where(whole_length > 0.0, least(whole_length, enough), enough),
                    Lanes{},
                    edges};
  if (any(at_corner)) {
    for (std::size_t i = 0; i < lane_count; ++i)
      geometry.beyond[i] = at((position[i] < 0.5 ? surface.previous : surface.next)[edges[i]]);
    geometry.length_beyond =
        where(at_corner, length_beyond<divided>(vertices, edge, geometry.beyond), Lanes{});
  }
  return geometry;
}

/// What the contacts of two corners have of the edges on the other side of the corner, where face goes on in face: edges of blocks of
/// order > 1 are divided at the same points on both sides of a joint, and of the contacts of the two vertices that meet there one is
/// left.
template <bool divided>
Lanes Detection::length_beyond(const Vertices& vertices, const Lanes (&edge)[lane_count],
                               const std::array<std::size_t, lane_count>& beyond) const {
  Lanes line[lane_count], length{};
  for (std::size_t i = 0; i < lane_count; ++i) line[i] = load(&corners_[beyond[i]].position.x);
  transpose(line);
  const Lanes ahead = edge[2] * line[2] + edge[3] * line[3], across = edge[2] * line[3] - edge[3] * line[2];
  const auto goes_on =
      (ahead >= 0.0) & (across * across <= Tolerances::sine_facing * Tolerances::sine_facing);
  if (!any(goes_on)) return length;
  for_facing<divided>(vertices, line, beyond, [&](const Vertices::Facing& f) { length += f.common; });
  return where(goes_on, length, Lanes{});
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

/// Which blocks meet where. Whether that is where the contact was before.
bool Detection::identify(const Found& found, const Candidate& candidate, Contact& contact) const {
  const bool same = contact.vertex == candidate.vertex && contact.edge == candidate.edge;
  contact.candidate = found.candidate;
  contact.block_a = candidate.block_a;
  contact.block_b = candidate.block_b;
  contact.vertex = candidate.vertex;
  contact.edge = candidate.edge;
  contact.normal = corners_[at(candidate.edge)].normal();
  return same;
}

/// As many as there are lanes, or fewer. Whether all of them are the same as before.
bool Detection::describe_some(const Surface& surface, const CandidateList& candidates,
                              std::span<const Found> found, std::span<Contact> contacts) const {
  static constexpr Memory nothing;
  const auto before = [&](const Found& f) -> const Memory& {
    return f.memory < 0 ? nothing : candidates.memory[at(f.memory)];
  };
  const Geometry geometry = wholes_.empty() ? measure<false>(surface, candidates, found)
                                            : measure<true>(surface, candidates, found);
  std::array<SpringLaw, lane_count> laws;
  bool same = true;
  LawLanes law{};
  law.gap = geometry.gap;
  law.length = geometry.length + geometry.length_beyond;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Candidate& candidate = candidates.pairs[at(found[i].candidate)];
    Contact& contact = contacts[i];
    same = identify(found[i], candidate, contact) && same;
    contact.position = geometry.position[i];
    if (is_curved(surface, contact.edge)) {
      contact.gap = geometry.gap[i];
      bend(surface, contact);
      law.gap[i] = contact.gap;
    }
    const double beyond = geometry.length_beyond[i];
    const Beyond over_corner{beyond > 0.0 ? beyond / law.length[i] : 0.0, surface.joint[geometry.beyond[i]]};
    const Memory& memory = before(found[i]);
    contact.memory.state = memory.state;
    contact.memory.bonded = memory.bonded;
    contact.memory.bond_length = memory.bond_length;
    if (memory.bonded) law.length[i] = memory.bond_length;
    find_law(surface, contact, over_corner, laws[i]);
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
  keep(memory, contacts.size(), [&](std::size_t i) -> Memory& { return contacts[i].memory; });
  return same;
}

bool Detection::describe(const Surface& surface, const CandidateList& candidates, ThreadTeam& team,
                         std::span<Contact> contacts, const OfSome& then) const {
  constexpr std::size_t most = 512;  // contacts that a second-level cache has room for
  std::atomic<bool> all_same = true;
  team.for_range(found_.size(), 2, [&](std::size_t first_piece, std::size_t last_piece) {
    bool same = true;
    for (std::size_t p = first_piece; p < last_piece; ++p) {
      const std::span<const Found> found = found_[p];
      const std::span<Contact> of_piece = contacts.subspan(first_found_[p], found.size());
      for (std::size_t begin = 0; begin < found.size(); begin += most) {
        const std::size_t end = std::min(found.size(), begin + most);
        for (std::size_t first = begin; first < end; first += lane_count) {
          const std::size_t count = std::min(end - first, std::size_t{lane_count});
          same = describe_some(surface, candidates, found.subspan(first, count),
                               of_piece.subspan(first, count)) &&
                 same;
        }
        if (then) then(first_found_[p] + begin, first_found_[p] + end);
      }
    }
    if (!same) all_same = false;
  });
  return all_same;
}

void keep_memory(std::span<const Contact> contacts, CandidateList& candidates, ThreadTeam& team) {
  candidates.make_room(contacts.size());
  team.for_range(contacts.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      candidates.memory[k] = contacts[k].memory;
      candidates.track(k, contacts[k].candidate);
    }
  });
}

}  // namespace keyblock::contact
