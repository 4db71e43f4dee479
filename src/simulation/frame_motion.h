#pragma once
#include "coupling/rock_column.h"
#include "simulation/checkpoint.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// How what displacements are relative to, the base or the outcrop, has moved since the start of the run: by the integrals of the ground
/// motions. It stops where a static stage begins.
dynamics::GroundMove frame_motion(const RunSetup& setup, const RunState& now);

}  // namespace keyblock::simulation
