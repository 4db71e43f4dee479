#pragma once
#include <utility>
#include <vector>

#include "geometry/vec2.h"

/// Parts of an outline by angles about a point, counter-clockwise from +x.
namespace keyblock::simulation {

/// Shares of an edge.
using Stretch = std::pair<double, double>;

/// Degrees from the start of an arc to the direction of p, in 0 … 360.
double angle_in_arc(Vec2 p, const std::pair<double, double>& arc);

/// The parts of a stretch of an edge from a to b within an arc, in degrees, about a point.
std::vector<Stretch> within_arc(const Stretch& stretch, Vec2 a, Vec2 b, Vec2 centre,
                                const std::pair<double, double>& arc);

}  // namespace keyblock::simulation
