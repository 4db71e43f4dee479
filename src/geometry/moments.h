#pragma once
#include <vector>

#include "geometry/polygon.h"

namespace keyblock {

/// Exact integrals of monomials over a polygon with holes, by Green's theorem edge by edge (simplex
/// integration: Shi 1994; compact form: Chen & Ohnishi 1999).
///
/// moments(p, c, h, d) returns M with M[index(i, j)] = ∫ ((x − c.x)/h)^i ((y − c.y)/h)^j dA for i + j ≤ d.
/// Centre c and scale h keep the numbers near 1: with raw coordinates every digit is lost by degree 10.
class Moments {
 public:
  Moments(const Polygon& polygon, Vec2 centre, double scale, int degree);
  [[nodiscard]] double operator()(int i, int j) const { return values_[index(i, j)]; }
  [[nodiscard]] int degree() const { return degree_; }
  /// Position of x^i y^j in graded order: 1, x, y, x², xy, y², …
  static constexpr std::size_t index(int i, int j) {
    const auto d = static_cast<std::size_t>(i + j);
    return d * (d + 1) / 2 + static_cast<std::size_t>(j);
  }

 private:
  int degree_;
  std::vector<double> values_;
};

}  // namespace keyblock
