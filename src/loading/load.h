#pragma once
#include <optional>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "loading/time_table.h"

namespace keyblock::loading {

/// A force at a material point, or a traction along a straight stretch of a block's boundary that varies linearly
/// from one end to the other (Hsiung 2001, equations 17-27), or as a parabola through the values at both ends and in the
/// middle. Per unit thickness; the load follows its block.
struct Load {
  std::string block;
  bool is_line = false;
  Vec2 from, to;          ///< the point (from), or the ends of the stretch, in reference position
  Vec2 value, value_end;  ///< N/m (force per thickness) at a point; Pa at the two ends of a stretch
  std::optional<Vec2> value_middle;  ///< Pa in the middle of a stretch: a parabola
  TimeTable factor;                  ///< empty: 1

  /// Traction at share s of a stretch, in Pa.
  [[nodiscard]] Vec2 traction(double s) const {
    const Vec2 linear = lerp(value, value_end, s);
    return value_middle ? linear + 4.0 * s * (1.0 - s) * (*value_middle - 0.5 * (value + value_end)) : linear;
  }
};

/// Springs from material points, or from every point of a straight stretch of boundary, to the ground.
struct Support {
  std::string name;  ///< may be empty
  std::string block;
  bool is_edge = false;
  std::vector<Vec2> points;  ///< the points, or the two ends of the stretch
  bool along_x = true, along_y = true;
  std::optional<double> stiffness;  ///< N/m per thickness at a point, Pa/m on a stretch; default 1000 × young
  TimeTable motion_x, motion_y;     ///< m, prescribed displacement of the ground end; empty: none
};

/// A spring between points of two blocks.
struct Spring {
  std::string name;                  ///< may be empty
  int staged = -1;                   ///< State::installed that says whether it is there; −1: always
  Vec2 from, to;                     ///< its ends, in reference position
  std::string from_block, to_block;  ///< empty: the block that holds the point
  double stiffness = 0.0;            ///< N/m per thickness
  std::optional<double> yield;       ///< N per thickness, largest force; empty: none
};

}  // namespace keyblock::loading
