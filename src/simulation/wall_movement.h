#pragma once
#include <span>
#include <vector>

#include "coupling/wall_loads.h"
#include "model/model.h"

namespace keyblock::simulation {

/// m, of a wall against where it was: inwards.
struct WallMovement {
  double crown = 0.0;       ///< where the line upwards from a centre meets it
  double springline = 0.0;  ///< mean of where the lines to both sides do
  double mean = 0.0;        ///< along the faces
};

/// Where the ends of faces are now: two for each.
std::vector<Vec2> ends_of(std::span<const dynamics::WallFace> faces, const dynamics::Model& model);

/// Of faces of blocks that are there; NaN where a line meets none. start: their ends before.
WallMovement movement_of(std::span<const dynamics::WallFace> faces, const dynamics::Model& model, Vec2 centre,
                         std::span<const Vec2> start);

}  // namespace keyblock::simulation
