#pragma once
#include "scenario/scenario.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// The motions as the base takes them. Over a compliant base that is the motion of an outcrop: twice the wave that goes up; of a record
/// within the ground, at a depth at or below the base, what makes the rock beside the model move so there. The record moves the base of a
/// column from there to the ground, and from the reaction R of the half-space on it
///
///     v_outcrop = v_record + R / (ρ c)
///
/// likewise by pressure. No spectrum is divided by. Where the base stands still while the ground moves, at ω₁ = π c/2H, 3 ω₁, ..., what the
/// record has wrong would grow without bounds. The column has the damping of the rock, and a drag of 2 ζ ω₁ m v, ζ = 1 %. It bounds R/(ρ c)
/// by 2/πζ times the record at each of these frequencies, and makes v_outcrop too large by ½ πζ at most between them. A record within the ground moves a rigid base at its depth as it is. Throws InputError
/// for depths that the model does not have. setup.boundary has its layers.
void take_to_base(const Scenario& scenario, simulation::RunSetup& setup);

}  // namespace keyblock::scenario
