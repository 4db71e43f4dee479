#pragma once
#include <vector>

#include "contact/contact.h"
#include "coupling/attempt.h"
#include "geometry/vec2.h"

namespace keyblock::dynamics {

/// Where a joint broke in a step: the bond of a contact, or what slip and opening take from its strength.
struct JointBreak {
  int vertex = 0, edge = 0;  ///< of the surface
  int block_a = 0, block_b = 0;
  contact::BreakMode mode = contact::BreakMode::none;
  Vec2 position;        ///< m, of the vertex at the start of the step
  double length = 0.0;  ///< m of joint that belongs to the contact
};

/// Appends what broke in an attempt that is taken, once State has what its contacts remember, and before blocks are moved:
///
/// | joint | event | mode |
/// |---|---|---|
/// | plain | it slips | shear |
/// | plain | it opens against its tension | tension |
/// | with residual strength | slip has taken all that it takes | shear |
/// | with residual strength | it loses its tension | tension |
/// | with residual strength, or without tension | it loses its cohesion, as it has opened | opening |
void find_breaks(const Attempt& attempt, std::vector<JointBreak>& breaks);

}  // namespace keyblock::dynamics
