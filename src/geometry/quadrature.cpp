#include "geometry/quadrature.h"

#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <utility>

namespace keyblock {

namespace {

LineRule make_gauss_legendre(int n) {
  LineRule rule{std::vector<double>(static_cast<std::size_t>(n)),
                std::vector<double>(static_cast<std::size_t>(n))};
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double derivative = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p0 = 1.0, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (x * p1 - p0) / (x * x - 1.0);
      const double step = p1 / derivative;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    const auto at = static_cast<std::size_t>(n - 1 - i);
    rule.points[at] = 0.5 * (1.0 + x);
    rule.weights[at] = 1.0 / ((1.0 - x * x) * derivative * derivative);
  }
  return rule;
}

/// Its points are the ends and the zeros of the slope of Legendre's polynomial of degree n − 1.
LineRule make_gauss_lobatto(int n) {
  const int degree = n - 1;
  LineRule rule;
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(std::numbers::pi * i / degree), value = 1.0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double before = 1.0;
      value = x;
      for (int k = 2; k <= degree; ++k)
        before = std::exchange(value, ((2 * k - 1) * x * value - (k - 1) * before) / k);
      const double step = (x * value - before) / (n * value);
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    rule.points.push_back(0.5 * (1.0 + x));
    rule.weights.push_back(1.0 / (degree * n * value * value));
  }
  return rule;
}

/// The rule of n points, by make(n) where it is not kept yet.
const LineRule& kept(std::map<int, LineRule>& rules, int n, LineRule (*make)(int)) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const auto found = rules.find(n);
  return found != rules.end() ? found->second : rules.emplace(n, make(n)).first->second;
}

}  // namespace

const LineRule& gauss_legendre(int n) {
  static std::map<int, LineRule> rules;
  return kept(rules, n, make_gauss_legendre);
}

const LineRule& gauss_lobatto(int n) {
  static std::map<int, LineRule> rules;
  return kept(rules, n, make_gauss_lobatto);
}

std::vector<WeightedPoint> polygon_rule(const Polygon& polygon, int degree) {
  const Vec2 c = centroid(polygon);
  if (degree <= 1) return {{c, area(polygon)}};
  // Triangle (c, a, b): x = c + r ((1 − s) a + s b − c), dA = r · |cross| dr ds. Degree + 1 in r, degree in
  // s.
  const LineRule& radial = gauss_legendre(degree / 2 + 1);
  const LineRule& along = gauss_legendre((degree + 2) / 2);
  std::vector<WeightedPoint> rule;
  for (std::size_t k = 0; k < polygon.ring_count(); ++k) {
    const Ring& ring = polygon.ring(k);
    for (std::size_t e = 0; e < ring.size(); ++e) {
      const Vec2 a = ring[e] - c, b = ring[(e + 1) % ring.size()] - c;
      const double twice_area = cross(a, b);
      if (twice_area == 0.0) continue;
      for (std::size_t i = 0; i < radial.points.size(); ++i) {
        for (std::size_t j = 0; j < along.points.size(); ++j) {
          const double r = radial.points[i];
          rule.push_back(
              {c + r * lerp(a, b, along.points[j]), twice_area * r * radial.weights[i] * along.weights[j]});
        }
      }
    }
  }
  return rule;
}

}  // namespace keyblock
