#pragma once
#include <span>

#include "contact/contact.h"
#include "contact/joint_law.h"
#include "contact/surface.h"

namespace keyblock::contact {

/// The edge whose joint says whether a contact is bonded, and remembers: its own, or at a seam that of the joint beyond, if only that has a bond.
inline int bonded_edge(const Surface& surface, std::span<const JointLaw> laws, const Contact& c) {
  const auto law_of = [&](int edge) {
    return laws[static_cast<std::size_t>(surface.joint_of(edge, c.block_a, c.block_b))];
  };
  if (law_of(c.edge).may_bond() || !c.at_corner || !surface.has_seam(c.vertex)) return c.edge;
  return (c.position < 0.5 ? surface.previous : surface.next)[static_cast<std::size_t>(c.edge)];
}

}  // namespace keyblock::contact
