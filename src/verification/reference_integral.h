#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "geometry/polygon.h"
#include "geometry/quadrature.h"

namespace keyblock::verification {

/// ∫ x^i y^j over triangles, by tensor products of Gauss rules.
inline double integral_over(const std::vector<std::array<Vec2, 3>>& triangles, int i, int j) {
  const LineRule& rule = gauss_legendre((i + j) / 2 + 3);
  double sum = 0.0;
  for (const auto& [a, b, c] : triangles) {
    for (std::size_t p = 0; p < rule.points.size(); ++p) {
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        const Vec2 x = lerp(a, lerp(b, c, rule.points[q]), rule.points[p]);
        sum += cross(b - a, c - a) * rule.points[p] * rule.weights[p] * rule.weights[q] * std::pow(x.x, i) *
               std::pow(x.y, j);
      }
    }
  }
  return sum;
}

}  // namespace keyblock::verification
