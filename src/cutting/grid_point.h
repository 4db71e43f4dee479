#pragma once
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>

#include "geometry/vec2.h"

namespace keyblock::cutting {

/// A point in whole steps of the grid on which the blocks are cut. |x|, |y| < 2⁴⁵, so that the predicates below are
/// exact. Ordered by y, then x.
struct GridPoint {
  std::int64_t x = 0;
  std::int64_t y = 0;

  friend constexpr bool operator==(GridPoint, GridPoint) = default;
  friend constexpr std::strong_ordering operator<=>(GridPoint a, GridPoint b) {
    if (const auto order = a.y <=> b.y; order != 0) return order;
    return a.x <=> b.x;
  }
};

__extension__ using Wide = __int128;

/// (b − a) × (c − a), exact.
constexpr Wide cross(GridPoint a, GridPoint b, GridPoint c) {
  return static_cast<Wide>(b.x - a.x) * (c.y - a.y) - static_cast<Wide>(b.y - a.y) * (c.x - a.x);
}

/// 1: a, b, c turn left; −1: right; 0: they lie on a line.
constexpr int orientation(GridPoint a, GridPoint b, GridPoint c) {
  const Wide turn = cross(a, b, c);
  return (turn > 0) - (turn < 0);
}

/// The point in grid steps; exact.
constexpr Vec2 to_vec2(GridPoint p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y)};
}

inline GridPoint nearest_grid_point(Vec2 p) {
  return {std::llround(p.x), std::llround(p.y)};
}

/// Whether segments ab and cd cross in a point inside both.
constexpr bool cross_properly(GridPoint a, GridPoint b, GridPoint c, GridPoint d) {
  return orientation(a, b, c) * orientation(a, b, d) < 0 && orientation(c, d, a) * orientation(c, d, b) < 0;
}

/// Whether p lies in the closed triangle abc, which may be flat.
constexpr bool in_triangle(GridPoint a, GridPoint b, GridPoint c, GridPoint p) {
  const int s = orientation(a, b, p), t = orientation(b, c, p), r = orientation(c, a, p);
  if (s == 0 && t == 0 && r == 0) return std::min({a, b, c}) <= p && p <= std::max({a, b, c});
  return (s >= 0 && t >= 0 && r >= 0) || (s <= 0 && t <= 0 && r <= 0);
}

}  // namespace keyblock::cutting
