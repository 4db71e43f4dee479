#include "contact/contact_description.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/contact_lanes.h"
#include "contact/edge_curve.h"
#include "core/index.h"

namespace keyblock::contact {

namespace {

/// The stiffness of a contact goes with the joint that belongs to it, and jumps when an edge comes to lie flat. Its elastic
/// energy stays what it was: penetration that the new spring would turn into energy nobody spent goes to the offset, and
/// comes back from there when the joint gets shorter again. What it has no room for is lost by a spring that gets softer. The pressure of
/// a face knows how much of it is closed, whatever the length: there the penetration stays.
void keep_energy(MemoryLanes& memory, Lanes gap, Lanes stiffness, LaneCondition in_face) {
  const Lanes zero{}, depth = -gap - memory.offset, ratio = memory.stiffness / stiffness;
  const auto is_other = (stiffness < memory.stiffness) | (stiffness > memory.stiffness),
             changes = (memory.stiffness > 0.0) & is_other & (depth > 0.0);
  const Lanes scale = square_root(ratio), wanted = scale * depth,
              offset = largest(-gap - wanted, least(memory.offset, zero)), now = -gap - offset;
  memory.stored = where(changes & ~in_face & (now < wanted),
                        memory.stored - 0.5 * stiffness * (wanted * wanted - now * now), memory.stored);
  memory.offset = where(changes & ~in_face, offset, memory.offset);
  memory.shear = where(changes, memory.shear * scale, memory.shear);
  memory.stiffness = stiffness;
}

/// Brings a contact from the chord of a piece of a divided edge to its curve: to the point that the vertex is opposite to.
void bring_to_curve(const Surface& surface, Contact& contact) {
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

/// Which blocks meet where. Whether that is where the contact was before.
bool identify(const Corners& corners, const FoundContact& found, const Candidate& candidate,
              Contact& contact) {
  const bool same = contact.vertex == candidate.vertex && contact.edge == candidate.edge;
  contact.candidate = found.candidate;
  contact.block_a = candidate.block_a;
  contact.block_b = candidate.block_b;
  contact.vertex = candidate.vertex;
  contact.edge = candidate.edge;
  contact.at_corner = found.at_corner;
  contact.normal = corners.all()[at(candidate.edge)].normal();
  return same;
}

/// m, of the edges at a vertex that are of a joint: what belongs to the vertex.
double length_at(const Surface& surface, int vertex, int joint) {
  const auto length = [&](int edge, bool is_start) {
    if (surface.joint[at(edge)] != joint) return 0.0;
    const double of_start = surface.start_share.empty() ? 0.5 : surface.start_share[at(edge)];
    return (is_start ? of_start : 1.0 - of_start) *
           norm(surface.position[at(surface.next[at(edge)])] - surface.position[at(edge)]);
  };
  return length(vertex, true) + length(surface.previous[at(vertex)], false);
}

/// m. A bond keeps its length. But one at a seam has that of the joint that it is left with, once the blocks have moved on.
double bond_length(const Surface& surface, const Contact& contact, const Memory& memory) {
  if (contact.at_corner || !surface.has_seam(contact.vertex)) return memory.bond_length;
  return std::min(memory.bond_length, length_at(surface, contact.vertex, surface.joint[at(contact.edge)]));
}

/// What the laws of joints make of the length that belongs to each contact. least_length: m, that gives stiffness at the least.
template <typename SpringLaw>
void put_springs(std::span<const SpringLaw> of_joints, Lanes least_length, LawLanes& law) {
  const auto of_joint = [&](double SpringLaw::*number) {
    return lanes_of(of_joints, [&](const SpringLaw& one) { return one.*number; });
  };
  const auto strength_of_joint = [&](double Strength::*number) {
    return lanes_of(of_joints, [&](const SpringLaw& one) { return one.strength.*number; });
  };
  law.normal_stiffness = of_joint(&SpringLaw::per_length) * largest(law.length, least_length);
  law.shear_stiffness = of_joint(&SpringLaw::stiffness_ratio) * law.normal_stiffness;
  law.friction = strength_of_joint(&Strength::friction_coefficient);
  law.cohesion = strength_of_joint(&Strength::cohesion) * law.length;
  law.tension = strength_of_joint(&Strength::tension) * law.length;
}

}  // namespace

/// The piece of joint that remembers for a contact, and how far that is worn: out, where there is none.
void ContactDescription::find_piece(const Surface& surface, const CandidateList& candidates,
                                    const FoundContact& found, Contact& contact) {
  Memory& memory = contact.memory;
  memory.piece = found.memory >= 0
                     ? candidates.memory[at(found.memory)].piece
                     : piece_of_new_contact(candidates.pieces, surface, contact.vertex, contact.edge);
  memory.worn = memory.piece < 0 ? JointLaw::worn_out : candidates.pieces[at(memory.piece)].worn;
}

/// Of a contact that knows its blocks and whether it is bonded. Written in place: numbers that are stored one by one are slow to copy
/// together.
void ContactDescription::find_law(const Surface& surface, const Contact& contact, const Beyond& beyond,
                                  SpringLaw& of_contact) const {
  const double penalty = std::min(penalty_[at(contact.block_a)], penalty_[at(contact.block_b)]);
  const std::size_t joint = at(surface.joint_of(contact.edge, contact.block_a, contact.block_b));
  const bool is_mixed = beyond.share > 0.0 && laws_[at(beyond.joint)] != laws_[joint];
  const JointLaw of_both =
      is_mixed ? mixed(laws_[joint], laws_[at(beyond.joint)], beyond.share, penalty) : JointLaw{};
  const JointLaw& law = is_mixed ? of_both : laws_[joint];
  const bool bonded = contact.memory.bonded;
  const double of_joint = law.normal_stiffness > 0.0 ? law.normal_stiffness : penalty,
               worn = law.has_memory() ? contact.memory.worn : 0.0;
  of_contact.fused = bonded && law.fused;
  of_contact.per_length = of_contact.fused ? std::max(of_joint, penalty) : of_joint;
  of_contact.stiffness_ratio = law.stiffness_ratio;
  of_contact.strength = law.strength(worn, bonded);
  of_contact.loss = law.loss(worn, bonded);
  of_contact.is_ductile = bonded && law.is_ductile(worn);
  if (contact.memory.is_torn) of_contact.strength.tension = 0.0;
  if (strengths_ == nullptr || strengths_->empty()) return;
  if (const ContactStrength* own = strengths_->find(contact.vertex, contact.edge))
    put_strength(*own, contact, of_contact);
}

void ContactDescription::put_strength(const ContactStrength& strength, const Contact& contact,
                                      SpringLaw& of_contact) {
  const auto put = [](double value, double& to) {
    if (ContactStrength::is_given(value)) to = value;
  };
  put(strength.friction_coefficient, of_contact.strength.friction_coefficient);
  if (ContactStrength::is_given(strength.friction_coefficient)) of_contact.loss.friction = 0.0;
  if (!contact.memory.bonded) return;
  if (ContactStrength::is_given(strength.cohesion)) of_contact.loss.cohesion = 0.0;
  put(strength.cohesion, of_contact.strength.cohesion);
  put(strength.tension, of_contact.strength.tension);
}

bool ContactDescription::describe(const Surface& surface, const Corners& corners,
                                  const CandidateList& candidates, std::span<const FoundContact> found,
                                  std::span<Contact> contacts) const {
  static constexpr Memory nothing;
  const auto before = [&](const FoundContact& f) -> const Memory& {
    return f.memory < 0 ? nothing : candidates.memory[at(f.memory)];
  };
  const ContactGeometry geometry =
      measure_contacts(surface, tolerances_, corners, candidates.pairs, found, candidates.memory);
  std::array<SpringLaw, lane_count> laws;
  bool same = true;
  LawLanes law{};
  law.gap = geometry.gap;
  law.length = geometry.length + geometry.length_beyond;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Candidate& candidate = candidates.pairs[at(found[i].candidate)];
    Contact& contact = contacts[i];
    same = identify(corners, found[i], candidate, contact) && same;
    contact.position = geometry.position[i];
    if (is_curved(surface, contact.edge)) {
      contact.gap = geometry.gap[i];
      bring_to_curve(surface, contact);
      law.gap[i] = contact.gap;
    }
    const double beyond = geometry.length_beyond[i];
    const Beyond over_corner{
        beyond > 0.0 ? beyond / law.length[i] : 0.0,
        surface.joint_of(static_cast<int>(geometry.beyond[i]), contact.block_a, contact.block_b)};
    const Memory& memory = before(found[i]);
    contact.memory.state = memory.state;
    contact.memory.bonded = memory.bonded;
    contact.memory.is_torn = memory.is_torn;
    contact.broke = BreakMode::none;
    contact.memory.in_face = contact.was_in_face = memory.in_face;
    if (memory.bonded) law.length[i] = bond_length(surface, contact, memory);
    if (has_memory_) find_piece(surface, candidates, found[i], contact);
    find_law(surface, contact, over_corner, laws[i]);
    contact.fused = laws[i].fused;
    contact.is_ductile = laws[i].is_ductile;
    contact.loss = laws[i].loss;
    contact.loss.cohesion *= law.length[i];
  }
  put_springs(std::span<const SpringLaw>(laws).first(contacts.size()), geometry.least_length, law);
  MemoryLanes memory =
      components_of<MemoryLanes>(found, [&](const FoundContact& f) { return &before(f).offset; });
  const auto is_new = lanes_where(found, [](const FoundContact& f) { return f.memory < 0; });
  const Lanes zero{}, born = largest(zero, -law.gap);
  memory.offset = where(is_new, born, where(memory.offset > 0.0, least(memory.offset, born), memory.offset));
  const auto in_face = lanes_where(found, [&](const FoundContact& f) { return before(f).in_face; });
  keep_energy(memory, law.gap, law.normal_stiffness, in_face);
  if (has_memory_)
    memory.worn =
        lanes_of(std::span<const Contact>(contacts), [](const Contact& c) { return c.memory.worn; });
  law.depth = -law.gap - memory.offset;
  keep(law, contacts);
  keep(memory, contacts.size(), [&](std::size_t i) -> Memory& { return contacts[i].memory; });
  return same;
}

}  // namespace keyblock::contact
