#include "geometry/quadrature.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

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

}  // namespace

const LineRule& gauss_legendre(int n) {
  static std::mutex mutex;
  static std::map<int, LineRule> rules;
  std::lock_guard lock(mutex);
  const auto found = rules.find(n);
  return found != rules.end() ? found->second : rules.emplace(n, make_gauss_legendre(n)).first->second;
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

namespace {

/// Legendre polynomials P_i(x) P_j(y), i + j ≤ degree, of points scaled to [−1, 1]².
std::vector<std::vector<double>> moments_of_points(const std::vector<WeightedPoint>& rule, int degree) {
  Box box;
  for (const WeightedPoint& w : rule) box.add(w.point);
  const Vec2 centre = 0.5 * (box.min + box.max), half = 0.5 * box.size();
  std::vector<std::vector<double>> moments(rule.size());
  const auto legendre = [&](double x) {
    std::vector<double> p{1.0, x};
    for (int k = 2; k <= degree; ++k)
      p.push_back(((2 * k - 1) * x * p[p.size() - 1] - (k - 1) * p[p.size() - 2]) / k);
    return p;
  };
  for (std::size_t q = 0; q < rule.size(); ++q) {
    const Vec2 at = rule[q].point - centre;
    const auto px = legendre(at.x / half.x), py = legendre(at.y / half.y);
    for (int i = 0; i <= degree; ++i) {
      for (int j = 0; i + j <= degree; ++j)
        moments[q].push_back(px[static_cast<std::size_t>(i)] * py[static_cast<std::size_t>(j)]);
    }
  }
  return moments;
}

/// The moments of all points in terms of those of some, the basis: column q of the tableau holds how much of each basis point
/// has the moments of point q.
class Tableau {
 public:
  explicit Tableau(std::vector<std::vector<double>> columns) : columns_(std::move(columns)) {
    const std::size_t rows = columns_[0].size();
    basis_.assign(rows, none);
    for (std::size_t step = 0; step < rows; ++step) {
      std::size_t row = none, column = none;
      double largest = least_pivot;
      for (std::size_t q = 0; q < columns_.size(); ++q) {
        for (std::size_t r = 0; r < rows; ++r) {
          if (basis_[r] == none && std::abs(columns_[q][r]) > largest) {
            largest = std::abs(columns_[q][r]);
            row = r;
            column = q;
          }
        }
      }
      if (row == none) return;  // the points do not tell the other moments apart
      exchange(row, column);
    }
  }
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  [[nodiscard]] const std::vector<std::size_t>& basis() const { return basis_; }
  [[nodiscard]] const std::vector<double>& column(std::size_t q) const { return columns_[q]; }
  /// Puts a point into the basis, in a row where its column is not zero.
  void exchange(std::size_t row, std::size_t point) {
    const std::vector<double> pivot = columns_[point];
    for (std::vector<double>& c : columns_) {
      const double value = c[row] / pivot[row];
      if (value == 0.0) continue;
      for (std::size_t r = 0; r < c.size(); ++r) c[r] -= value * pivot[r];
      c[row] = value;
    }
    basis_[row] = point;
  }

 private:
  static constexpr double least_pivot = 1e-12;
  std::vector<std::vector<double>> columns_;
  std::vector<std::size_t> basis_;
};

/// Moves the weight of one point to those of the basis, until it or one of them has none left.
void move_weight(Tableau& tableau, std::size_t point, std::vector<WeightedPoint>& rule) {
  const std::vector<double>& column = tableau.column(point);
  double share = 1.0;
  std::size_t leaves = Tableau::none;
  for (std::size_t r = 0; r < column.size(); ++r) {
    if (tableau.basis()[r] == Tableau::none) continue;
    const double weight = rule[tableau.basis()[r]].weight, change = rule[point].weight * column[r];
    if (weight * change < 0.0 && share * std::abs(change) > std::abs(weight)) {
      share = std::abs(weight / change);
      leaves = r;
    }
  }
  const double moved = share * rule[point].weight;
  for (std::size_t r = 0; r < column.size(); ++r) {
    if (tableau.basis()[r] != Tableau::none) rule[tableau.basis()[r]].weight += moved * column[r];
  }
  rule[point].weight -= moved;
  if (leaves == Tableau::none) {
    rule[point].weight = 0.0;
    return;
  }
  rule[tableau.basis()[leaves]].weight = 0.0;
  tableau.exchange(leaves, point);
}

}  // namespace

std::vector<WeightedPoint> thinned_rule(const std::vector<WeightedPoint>& rule, int degree) {
  constexpr int highest = 12;
  constexpr double rounding = 1e-13;  // of the sum of all weights
  if (degree < 1 || degree > highest || rule.size() <= 1) return rule;
  const std::vector<std::vector<double>> moments = moments_of_points(rule, degree);
  if (rule.size() <= moments[0].size()) return rule;
  Tableau tableau(moments);
  std::vector<WeightedPoint> thin = rule;
  for (std::size_t q = 0; q < rule.size(); ++q) {
    if (std::find(tableau.basis().begin(), tableau.basis().end(), q) == tableau.basis().end())
      move_weight(tableau, q, thin);
  }
  double total = 0.0;
  for (const WeightedPoint& w : rule) total += std::abs(w.weight);
  for (std::size_t k = 0; k < moments[0].size(); ++k) {
    double missing = 0.0;
    for (std::size_t q = 0; q < rule.size(); ++q)
      missing += (thin[q].weight - rule[q].weight) * moments[q][k];
    if (!(std::abs(missing) <= rounding * total)) return rule;
  }
  std::erase_if(thin, [](const WeightedPoint& w) { return w.weight == 0.0; });
  return thin;
}

}  // namespace keyblock
