#pragma once
#include <optional>
#include <span>

#include "geometry/polygon.h"
#include "model/model.h"
#include "model/state.h"
#include "record/record.h"

namespace keyblock::simulation {

/// Two material points in the walls of an opening, where a line through its centroid leaves it.
struct Diameter {
  Vec2 ends[2];              ///< reference positions
  int blocks[2] = {-1, -1};  ///< that hold them; −1: none does
  double length = 0.0;       ///< m, at the start
  double closure = 0.0;      ///< m, before the last excavation
};

/// The diameter of an outline along a unit vector, now.
Diameter diameter_of(const Ring& outline, Vec2 direction, const dynamics::Model& model,
                     const dynamics::State& state);

/// m, by how much the ends of a diameter have come nearer. Where the block of one is excavated, or none holds it, `d.closure`; else NaN
/// while one of them is on a block that has fallen. `status`: of every block now.
double closure(const Diameter& d, const dynamics::Model& model, const dynamics::State& state,
               std::span<const record::BlockStatus> status);

}  // namespace keyblock::simulation
