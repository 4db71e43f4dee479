#include "scenario/block_shapes.h"

#include <algorithm>
#include <cmath>

namespace keyblock::scenario {
namespace {

double nearest_count(double length, double part) {
  return std::max(1.0, std::round(length / part));
}

}  // namespace

std::vector<Ring> arch_stones(const ArchShape& arch) {
  const double w = 0.5 * arch.span, h = arch.rise;
  const double r = (w * w + h * h) / (2.0 * h);
  const double half_angle = std::atan2(w, r - h);
  const Vec2 centre = arch.springing + Vec2{0.0, h - r};
  const auto at = [&](int k, double radius) {
    const double angle = half_angle * (1.0 - 2.0 * k / arch.voussoirs);
    return centre + radius * Vec2{-std::sin(angle), std::cos(angle)};
  };
  std::vector<Ring> stones;
  for (int k = 0; k < arch.voussoirs; ++k)
    stones.push_back({at(k, r), at(k + 1, r), at(k + 1, r + arch.thickness), at(k, r + arch.thickness)});
  return stones;
}

std::vector<Ring> column_stones(const ColumnShape& column) {
  const auto at = [&](int k, double side) {
    const double share = static_cast<double>(k) / column.drums;
    const double width = (1.0 - share) * column.width + share * column.top_width;
    return column.foot + Vec2{0.5 * side * width, share * column.height};
  };
  std::vector<Ring> stones;
  for (int k = 0; k < column.drums; ++k)
    stones.push_back({at(k, -1.0), at(k, 1.0), at(k + 1, 1.0), at(k + 1, -1.0)});
  return stones;
}

std::vector<Ring> wall_stones(const WallShape& wall) {
  const int courses = static_cast<int>(nearest_count(wall.height, wall.course_height));
  const int stones_of_course = static_cast<int>(nearest_count(wall.length, wall.stone_length));
  std::vector<Ring> stones;
  for (int course = 0; course < courses; ++course) {
    const double low = wall.height * course / courses, high = wall.height * (course + 1) / courses;
    std::vector<double> joints{0.0};
    for (int k = course % 2 == 1 && wall.bond > 0.0 ? 0 : 1; k <= stones_of_course; ++k) {
      const double shift = course % 2 == 1 ? wall.bond : 0.0;
      joints.push_back(std::min(wall.length, wall.length * (k + shift) / stones_of_course));
    }
    for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
      const Vec2 a = wall.corner + Vec2{joints[k], low}, b = wall.corner + Vec2{joints[k + 1], high};
      stones.push_back({a, {b.x, a.y}, b, {a.x, b.y}});
    }
  }
  return stones;
}

double count_of_stones(const WallShape& wall) {
  return nearest_count(wall.height, wall.course_height) *
         (nearest_count(wall.length, wall.stone_length) + 0.5);
}

}  // namespace keyblock::scenario
