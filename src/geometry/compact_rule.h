#pragma once
#include <vector>

#include "geometry/quadrature.h"

namespace keyblock {

/// A rule over a polygon with holes, exact for polynomials of total degree ≤ `degree`, of few points: 0.4 for each of their moments,
/// rounded up to a multiple of as many as are computed at once: 8 of degree 4, 24 of degree 8, 40 of degree 12. Weights are positive,
/// whatever the shape; points may lie a little outside of it.
///
/// A point has three numbers to choose. Points spread evenly are moved, and their weights with them, by as little as gives the moments
/// that are missing, until they are right to the last digits (Gauss and Newton's method of least squares; Xiao & Gimbutas 2010), in
/// coordinates in which the polygon has unit second moments: thin and inclined polygons have as good rules as others. Degrees 0, 1 and
/// above 12 have the rule of polygon_rule(), as have polygons for which the iteration does not end.
std::vector<WeightedPoint> compact_rule(const Polygon& polygon, int degree);

}  // namespace keyblock
