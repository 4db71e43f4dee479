#pragma once
#include <optional>
#include <string>

#include "geometry/vec2.h"
#include "loading/time_table.h"

namespace keyblock::loading {

/// A force at a material point, or a traction along a straight stretch of a block's boundary that varies linearly
/// from one end to the other (Hsiung 2001, equations 17-27). Per unit thickness; the load follows its block.
struct Load {
  std::string block;
  bool is_line = false;
  Vec2 from, to;          ///< the point (from), or the ends of the stretch, in reference position
  Vec2 value, value_end;  ///< N/m (force per thickness) at a point; Pa at the two ends of a stretch
  TimeTable factor;       ///< empty: 1
};

/// Springs from material points, or from every point of a straight stretch of boundary, to the ground.
struct Support {
  std::string block;
  bool is_edge = false;
  std::vector<Vec2> points;  ///< the points, or the two ends of the stretch
  bool along_x = true, along_y = true;
  std::optional<double> stiffness;  ///< N/m per thickness at a point, Pa/m on a stretch; default 1000 × young
  TimeTable motion_x, motion_y;     ///< m, prescribed displacement of the ground end; empty: none
};

}  // namespace keyblock::loading
