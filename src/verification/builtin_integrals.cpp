#include <cmath>

#include "geometry/moments.h"
#include "geometry/polygon.h"
#include "geometry/quadrature.h"
#include "verification/builtin.h"
#include "verification/reference_integral.h"

namespace keyblock::verification {
namespace {

constexpr int degree = 22;

// Concave outlines, holes, islands of few and of many edges. Coordinates are positive, so that no integral is a small
// difference of large parts, whose relative error would say nothing.
std::vector<Polygon> polygons() {
  std::vector<Polygon> all{{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}},
                           {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, {}},
                           {{{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}},
                            {{{0.2, 0.2}, {0.4, 0.6}, {0.6, 0.2}}}}};
  Polygon star;
  for (int k = 0; k < 14; ++k) {
    const double angle = 0.448798950512827605 * k, radius = k % 2 == 0 ? 2.0 : 0.9;  // π/7
    star.outer.push_back({2.1 + radius * std::cos(angle), 2.1 + radius * std::sin(angle)});
  }
  star.holes = {{{1.8, 2.0}, {2.0, 2.4}, {2.4, 2.1}}, {{2.3, 1.6}, {2.2, 1.8}, {2.5, 1.9}}};
  all.push_back(star);
  for (Polygon& polygon : all) orient(polygon);
  return all;
}

}  // namespace

BuiltinResults polygon_integrals(const std::vector<std::filesystem::path>&) {
  double by_edges = 0.0, by_rule = 0.0;
  int integrals = 0;
  for (const Polygon& polygon : polygons()) {
    const Moments moments(polygon, {0, 0}, 1.0, degree);
    const auto rule = polygon_rule(polygon, degree);
    const auto triangles = triangulate(polygon);
    for (int i = 0; i <= degree; ++i) {
      for (int j = 0; i + j <= degree; ++j) {
        const double expected = integral_over(triangles, i, j);
        double sum = 0.0;
        for (const WeightedPoint& w : rule) sum += w.weight * std::pow(w.point.x, i) * std::pow(w.point.y, j);
        by_edges = std::max(by_edges, std::abs(moments(i, j) / expected - 1.0));
        by_rule = std::max(by_rule, std::abs(sum / expected - 1.0));
        ++integrals;
      }
    }
  }
  return {{"integrals", integrals}, {"largest_error_by_edges", by_edges}, {"largest_error_by_rule", by_rule}};
}

}  // namespace keyblock::verification
