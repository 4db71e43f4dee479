#pragma once
#include "coupling/points.h"
#include "coupling/row.h"
#include "model/drive.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// m/s, with which the sides of a contact approach at the start of the step.
inline double speed_of_approach(const State& state, const Drive& drive, const Points& points,
                                const contact::Contact& contact, const Row& row) {
  return -dot(row.normal, relative_displacement(points, row, state.velocity) +
                              drive.prescribed_between(contact) / drive.step);
}

/// Whether the sides of a contact that approach at this speed, m/s, have met before the last step: what has pressed for longer is no impact.
inline bool has_met_before(const contact::Contact& contact, double speed, const Drive& drive) {
  return contact.depth > speed * drive.step;
}

}  // namespace keyblock::dynamics
