#pragma once
#include "geometry/polygon.h"

/// Polygons that several tests look at.
namespace keyblock {

/// 4 × 3, with a hole of 1 × 1.
inline const Polygon frame{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
inline const Polygon l_shape{{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, {}};

}  // namespace keyblock
