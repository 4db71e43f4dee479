#pragma once
#include <vector>

#include "geometry/polygon.h"

namespace keyblock {

/// Gauss-Legendre rule on [0, 1], exact for degree 2n − 1.
struct LineRule {
  std::vector<double> points;
  std::vector<double> weights;
};
const LineRule& gauss_legendre(int n);  ///< n ≥ 1; rules are computed once and kept
/// Gauss-Lobatto rule of n ≥ 2 points on [0, 1], both ends among them, ascending; exact for degree 2n − 3.
const LineRule& gauss_lobatto(int n);

/// A point of a rule over a region.
struct WeightedPoint {
  Vec2 point;
  double weight = 0.0;  ///< m²
};

/// A rule over a polygon with holes, exact for polynomials of total degree ≤ `degree`.
///
/// The region is the signed sum of the triangles from its centroid to every edge, each with a collapsed Gauss
/// rule; so for a region that is not star-shaped some weights are negative and some points lie outside. That
/// is exact for polynomials, which is what it is for. Rules of degree ≤ 1 are the centroid alone.
std::vector<WeightedPoint> polygon_rule(const Polygon& polygon, int degree);

}  // namespace keyblock
