#pragma once
#include <vector>

#include "geometry/polygon.h"

/// Masonry by its measures. Every stone is a ring, counter-clockwise; m.
namespace keyblock::scenario {

/// A segmental arch. Its intrados runs through both springings and, by the rise h over the half span w, through the crown:
///
///     r = (w² + h²)/2h,   sin α = w/r,
///
/// with α half its angle. Joints are radial, of equal angles; faces are chords between them.
struct ArchShape {
  Vec2 springing;  ///< middle between the two springings of the intrados
  double span = 0.0, rise = 0.0, thickness = 0.0;
  int voussoirs = 0;
};
/// From the left springing to the right one.
std::vector<Ring> arch_stones(const ArchShape& arch);

/// A column of drums of equal height, whose width changes evenly.
struct ColumnShape {
  Vec2 foot;  ///< middle of its base
  double height = 0.0, width = 0.0, top_width = 0.0;
  int drums = 0;
};
/// From the foot upwards.
std::vector<Ring> column_stones(const ColumnShape& column);

/// A wall in courses, each second one shifted by a share of a stone. Stones and courses are as many as come nearest to their measures, and then
/// of equal size: their measures are those nearest to the wanted ones that fill the wall.
struct WallShape {
  Vec2 corner;  ///< lower left
  double length = 0.0, height = 0.0, stone_length = 0.0, course_height = 0.0;
  double bond = 0.5;  ///< of a stone; 0: joints stand one over the other
};
/// Course by course upwards, from left to right.
std::vector<Ring> wall_stones(const WallShape& wall);
/// How many that will be, for measures that may be absurd.
double count_of_stones(const WallShape& wall);

}  // namespace keyblock::scenario
