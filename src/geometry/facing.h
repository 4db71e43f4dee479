#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/vec2.h"

namespace keyblock {

/// A stretch of an edge, m from its start.
struct FacingStretch {
  double from = 0.0, to = 0.0;
};

/// What edge `a` has in common with edge `b`, which runs the other way along it, no farther than a distance (m) from its line. None where
/// they share no more than that.
inline std::optional<FacingStretch> facing_stretch(Vec2 a_from, Vec2 a_to, Vec2 b_from, Vec2 b_to,
                                                   double distance) {
  constexpr double parallel = 1e-2;  // sine of the angle between them
  const double length = norm(a_to - a_from), other = norm(b_to - b_from);
  if (!(length > distance) || !(other > distance)) return std::nullopt;
  const Vec2 along = (a_to - a_from) / length, back = (b_to - b_from) / other;
  if (dot(along, back) > 0.0 || std::abs(cross(along, back)) > parallel) return std::nullopt;
  if (std::abs(cross(along, b_from - a_from)) > distance || std::abs(cross(along, b_to - a_from)) > distance)
    return std::nullopt;
  const double from = std::max(0.0, dot(b_to - a_from, along)),
               to = std::min(length, dot(b_from - a_from, along));
  if (!(to - from > distance)) return std::nullopt;
  return FacingStretch{from, to};
}

}  // namespace keyblock
