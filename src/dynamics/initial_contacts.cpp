#include "dynamics/initial_contacts.h"

#include <algorithm>
#include <cmath>

#include "contact/law.h"
#include "core/index.h"

namespace keyblock::dynamics {

namespace {

/// The joint carries the stress of the rock from the start: traction on block a is −σ n. J per thickness.
double carry_stress(const Model& model, const contact::JointLaw& law, contact::Contact& c) {
  const contact::Surface& surface = model.surface;
  const int end = surface.next[at(c.edge)];
  const Vec2 where = lerp(surface.position[at(c.edge)], surface.position[at(end)], c.position);
  const block::Stress s = block::in_situ_at(model.in_situ, where);
  const Vec2 traction{s.xx * c.normal.x + s.xy * c.normal.y, s.xy * c.normal.x + s.yy * c.normal.y};
  const double normal = std::max(0.0, -dot(traction, c.normal) * c.length);
  const double bound =
      law.fused ? HUGE_VAL
                : contact::shear_strength(law.friction_coefficient, normal, law.cohesion * c.length);
  const double shear = std::clamp(dot(traction, c.tangent()) * c.length, -bound, bound);
  contact::Memory& memory = c.memory;
  memory.normal_force = memory.bounding_force = normal;
  memory.offset = -c.gap - normal / c.normal_stiffness;
  memory.shear = shear / c.shear_stiffness;
  memory.state = normal > 0.0 ? contact::State::locked : contact::State::open;
  memory.stored = 0.5 * (normal * normal / c.normal_stiffness + shear * shear / c.shear_stiffness);
  return memory.stored;
}

}  // namespace

double begin_contacts(const Model& model, const contact::Tolerances& tolerances,
                      std::span<contact::Contact> contacts) {
  double stored = 0.0;
  for (contact::Contact& c : contacts) {
    if (std::abs(c.gap) > tolerances.in_place || c.length <= tolerances.rounding) continue;
    const contact::JointLaw& law = model.laws[at(model.surface.joint[at(c.edge)])];
    c.memory.bonded = law.may_bond();
    if (c.memory.bonded) {
      c.memory.bond_length = c.length;
      c.memory.offset = -c.gap;  // a gap that is there does not pull
    }
    if (model.in_situ) stored += carry_stress(model, law, c);
  }
  return stored;
}

}  // namespace keyblock::dynamics
