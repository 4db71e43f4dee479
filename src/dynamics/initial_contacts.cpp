#include "dynamics/initial_contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "contact/bonded_edge.h"
#include "contact/law.h"
#include "core/index.h"
#include "coupling/facets.h"

namespace keyblock::dynamics {

namespace {

/// Where contacts are on their edges, before the first step.
Vec2 place_of(const Model& model, const contact::Contact& c) {
  const contact::Surface& surface = model.surface;
  return lerp(surface.position[at(c.edge)], surface.position[at(surface.next[at(c.edge)])], c.position);
}

/// The law that says whether a contact is bonded, and remembers.
const contact::JointLaw& law_of(const Model& model, const contact::Contact& c) {
  const int edge = contact::bonded_edge(model.surface, model.laws, c);
  return model.laws[at(model.surface.joint_of(edge, c.block_a, c.block_b))];
}

/// Pa, of the water in the joint at each contact; empty where there is no water.
std::vector<double> water_pressures(const Model& model, const State& state,
                                    std::span<const contact::Contact> contacts) {
  const WaterOfModel water = water_of(model, state);
  if (water.water == nullptr) return {};
  std::vector<EdgePlace> places;
  for (const contact::Contact& c : contacts) places.push_back({c.edge, place_of(model, c)});
  return water.water->pressures(model, state, water.memory, places);
}

/// The joint carries the stress of the rock from the start, less what the water in it has of that, Pa: traction on block a is −σ n. J per
/// thickness.
double carry_stress(const Model& model, const contact::JointLaw& law, double of_water, contact::Contact& c) {
  const block::Stress s = block::in_situ_at(model.in_situ, place_of(model, c));
  const Vec2 traction{s.xx * c.normal.x + s.xy * c.normal.y, s.xy * c.normal.x + s.yy * c.normal.y};
  const double normal = std::max(0.0, (-dot(traction, c.normal) - of_water) * c.length);
  const contact::Strength peak = law.strength(0.0, true);
  const double bound =
      law.fused ? HUGE_VAL
                : contact::shear_strength(peak.friction_coefficient, normal, peak.cohesion * c.length);
  const double shear = std::clamp(dot(traction, c.tangent()) * c.length, -bound, bound);
  contact::Memory& memory = c.memory;
  memory.normal_force = memory.bounding_force = normal;
  memory.offset = -c.gap - normal / c.normal_stiffness;
  memory.shear = shear / c.shear_stiffness;
  memory.state = normal > 0.0 ? contact::State::locked : contact::State::open;
  memory.stored = 0.5 * (normal * normal / c.normal_stiffness + shear * shear / c.shear_stiffness);
  return memory.stored;
}

/// Pieces of joint for the contacts that `in_place` names, into contacts, whose laws have memory.
void make_pieces(const Model& model, const std::vector<std::size_t>& in_place,
                 std::span<contact::Contact> contacts, contact::JointPieces& pieces) {
  pieces.clear();
  for (const std::size_t k : in_place) {
    const contact::Contact& c = contacts[k];
    if (law_of(model, c).has_memory())
      pieces.push_back({.vertex = c.vertex, .edge = c.edge, .is_touched = true});
  }
  std::ranges::sort(pieces, {}, [](const contact::JointPiece& p) { return std::pair(p.vertex, p.edge); });
  for (contact::Contact& c : contacts) {
    if (!law_of(model, c).has_memory()) continue;
    c.memory.piece = contact::piece_of_new_contact(pieces, model.surface, c.vertex, c.edge);
    c.memory.worn = c.memory.piece < 0 ? contact::JointLaw::worn_out : 0.0;
  }
}

}  // namespace

double begin_contacts(const Model& model, const State& state, const contact::Tolerances& tolerances,
                      std::span<contact::Contact> contacts, contact::JointPieces& pieces) {
  double stored = 0.0;
  std::vector<std::size_t> in_place;
  const std::vector<double> of_water =
      model.in_situ ? water_pressures(model, state, contacts) : std::vector<double>{};
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    contact::Contact& c = contacts[k];
    if (std::abs(c.gap) > tolerances.in_place || c.length <= tolerances.rounding) continue;
    in_place.push_back(k);
    const contact::JointLaw& law = law_of(model, c);
    c.memory.bonded = law.may_bond();
    if (c.memory.bonded) {
      c.memory.bond_length = c.length;
      c.memory.offset = -c.gap;  // a gap that is there does not pull
    }
    if (model.in_situ) stored += carry_stress(model, law, of_water.empty() ? 0.0 : of_water[k], c);
  }
  make_pieces(model, in_place, contacts, pieces);
  return stored;
}

}  // namespace keyblock::dynamics
