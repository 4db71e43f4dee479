#include "geometry/moments.h"

#include "geometry/quadrature.h"

namespace keyblock {

// For a homogeneous polynomial p of degree d, Euler's theorem gives ∫_Ω p dA = 1/(d+2) Σ_edges (a × b) ∫₀¹
// p(a + s(b−a)) ds; the line integral is done exactly by Gauss-Legendre.
Moments::Moments(const Polygon& polygon, Vec2 centre, double scale, int degree)
    : degree_(degree), values_(index(0, degree) + 1, 0.0) {
  const LineRule& rule = gauss_legendre(degree / 2 + 1);
  std::vector<double> x_power(static_cast<std::size_t>(degree) + 1), y_power(x_power.size());
  for (std::size_t k = 0; k < polygon.ring_count(); ++k) {
    const Ring& ring = polygon.ring(k);
    for (std::size_t e = 0; e < ring.size(); ++e) {
      const Vec2 a = (ring[e] - centre) / scale, b = (ring[(e + 1) % ring.size()] - centre) / scale;
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        const Vec2 p = lerp(a, b, rule.points[q]);
        x_power[0] = y_power[0] = 1.0;
        for (std::size_t d = 1; d < x_power.size(); ++d) {
          x_power[d] = x_power[d - 1] * p.x;
          y_power[d] = y_power[d - 1] * p.y;
        }
        const double factor = cross(a, b) * rule.weights[q] * scale * scale;
        for (int d = 0; d <= degree; ++d) {
          for (int j = 0; j <= d; ++j) {
            values_[index(d - j, j)] += factor / (d + 2) * x_power[static_cast<std::size_t>(d - j)] *
                                        y_power[static_cast<std::size_t>(j)];
          }
        }
      }
    }
  }
}

}  // namespace keyblock
