#include "geometry/compact_rule.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "core/lanes.h"
#include "geometry/moments.h"

namespace keyblock {

namespace {

using Numbers = std::vector<double>;

double largest(const Numbers& numbers) {
  double most = 0.0;
  for (const double x : numbers) most = std::max(most, std::abs(x));
  return most;
}

/// Coordinates (ξ, η) in which a polygon has its centroid in the origin and unit second moments: X = centre + ξ first + η second.
class Frame {
 public:
  explicit Frame(const Polygon& polygon) : centre_(centroid(polygon)) {
    const double scale = norm(bounds(polygon).size());
    const Moments m(polygon, centre_, scale, 2);
    const double xx = m(2, 0) / m(0, 0), xy = m(1, 1) / m(0, 0), yy = m(0, 2) / m(0, 0);
    first_ = scale / std::sqrt(xx) * Vec2{xx, xy};
    second_ = {0.0, scale * std::sqrt(yy - xy * xy / xx)};
  }
  [[nodiscard]] double determinant() const { return first_.x * second_.y; }
  [[nodiscard]] Vec2 point(Vec2 xi) const { return centre_ + xi.x * first_ + xi.y * second_; }
  [[nodiscard]] Vec2 coordinates(Vec2 x) const {
    const Vec2 from = x - centre_;
    const double first = from.x / first_.x;
    return {first, (from.y - first * first_.y) / second_.y};
  }
  [[nodiscard]] Polygon coordinates(Polygon polygon) const {
    const auto change = [&](Ring& ring) {
      for (Vec2& x : ring) x = coordinates(x);
    };
    change(polygon.outer);
    for (Ring& hole : polygon.holes) change(hole);
    return polygon;
  }

 private:
  Vec2 centre_, first_, second_;
};

/// Legendre's polynomials up to a degree, and their derivatives.
struct Legendre {
  Numbers value, slope;
  Legendre(int degree, double x) : value{1.0, x}, slope{0.0, 1.0} {
    for (int k = 2; k <= degree; ++k) {
      const std::size_t i = at(k);
      value.push_back(((2 * k - 1) * x * value[i - 1] - (k - 1) * value[i - 2]) / k);
      slope.push_back(slope[i - 2] + (2 * k - 1) * value[i - 1]);
    }
  }
};

/// x ← A⁻¹ x for a symmetric, positive definite A, whose lower triangle is given, by rows of as many numbers as x has, and lost. False
/// where it is not positive definite.
bool solve_symmetric(Numbers& a, Numbers& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    double* row = &a[i * n];
    for (std::size_t j = 0; j <= i; ++j) {
      const double* other = &a[j * n];
      double sum = row[j];
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      if (i == j && !(sum > 0.0)) return false;
      row[j] = i == j ? std::sqrt(sum) : sum / other[j];
    }
    for (std::size_t k = 0; k < i; ++k) x[i] -= row[k] * x[k];
    x[i] /= row[i];
  }
  for (std::size_t i = n; i-- > 0;) {
    x[i] /= a[i * n + i];
    for (std::size_t k = 0; k < i; ++k) x[k] -= a[i * n + k] * x[i];
  }
  return true;
}

/// Points and weights on their way to a rule. Moments are those of products of Legendre's polynomials of the box around the polygon,
/// over its area.
class Search {
 public:
  Search(const Polygon& polygon, int degree)
      : degree_(degree),
        size_(at((degree + 1) * (degree + 2) / 2)),
        area_(area(polygon)),
        wanted_(size_, 0.0) {
    const Box box = bounds(polygon);
    middle_ = 0.5 * (box.min + box.max);
    half_ = 0.5 * box.size();
    for (const WeightedPoint& w : polygon_rule(polygon, degree)) {
      const Legendre x = along_x(w.point), y = along_y(w.point);
      for_moments([&](std::size_t k, std::size_t i, std::size_t j) {
        wanted_[k] += w.weight / area_ * x.value[i] * y.value[j];
      });
    }
  }

  /// Points, a multiple of as many as there are lanes, spread evenly over a disc with about the moments of the polygon, each a golden
  /// angle from the last.
  void start(std::size_t points) {
    constexpr double radius = 1.9;  // a disc of radius 2 has unit second moments
    constexpr Vec2 turn{-0.7373688780783197, 0.6754902942615238};
    Vec2 direction{1.0, 0.0};
    for (std::size_t q = 0; q < points; ++q) {
      const double share = (static_cast<double>(q) + 0.5) / static_cast<double>(points);
      rule_.push_back({radius * std::sqrt(share) * direction, area_ / static_cast<double>(points)});
      direction = {turn.x * direction.x - turn.y * direction.y, turn.y * direction.x + turn.x * direction.y};
    }
    columns_ = 3 * points;
  }

  /// Finds the moments that are missing, and how each changes with weights, relative to themselves, and points. The largest.
  double look() {
    missing_ = wanted_;
    change_.resize(size_ * columns_);
    for (std::size_t q = 0; q < rule_.size(); ++q) {
      const Legendre x = along_x(rule_[q].point), y = along_y(rule_[q].point);
      const double weight = rule_[q].weight / area_;
      for_moments([&](std::size_t k, std::size_t i, std::size_t j) {
        const double moment = weight * x.value[i] * y.value[j];
        missing_[k] -= moment;
        double* of_point = &change_[k * columns_ + 3 * q];
        of_point[0] = moment;
        of_point[1] = weight / half_.x * x.slope[i] * y.value[j];
        of_point[2] = weight / half_.y * x.value[i] * y.slope[j];
      });
    }
    return largest(missing_);
  }

  /// The least change that would give all that is missing if moments changed evenly, or as much of it as can be trusted. False when
  /// there is none.
  bool move() {
    constexpr double most = 0.5;
    Numbers products(size_ * size_);
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        const double *a = &change_[i * columns_], *b = &change_[j * columns_];
        Lanes of_lanes{};
        for (std::size_t c = 0; c < columns_; c += lane_count) of_lanes += load(a + c) * load(b + c);
        products[i * size_ + j] = sum(of_lanes);
      }
    }
    if (!solve_symmetric(products, missing_)) return false;
    Numbers step(columns_, 0.0);
    for (std::size_t k = 0; k < size_; ++k) {
      for (std::size_t c = 0; c < columns_; ++c) step[c] += missing_[k] * change_[k * columns_ + c];
    }
    const double share = std::min(1.0, most / largest(step));
    for (std::size_t q = 0; q < rule_.size(); ++q) {
      rule_[q].weight *= 1.0 + share * step[3 * q];
      rule_[q].point += share * Vec2{step[3 * q + 1], step[3 * q + 2]};
    }
    return true;
  }

  [[nodiscard]] const std::vector<WeightedPoint>& rule() const { return rule_; }

 private:
  [[nodiscard]] Legendre along_x(Vec2 point) const { return {degree_, (point.x - middle_.x) / half_.x}; }
  [[nodiscard]] Legendre along_y(Vec2 point) const { return {degree_, (point.y - middle_.y) / half_.y}; }
  /// Calls what(k, i, j) for moment k, of P_i(x) P_j(y).
  template <typename Do>
  void for_moments(const Do& what) const {
    std::size_t k = 0;
    for (int i = 0; i <= degree_; ++i) {
      for (int j = 0; i + j <= degree_; ++j) what(k++, at(i), at(j));
    }
  }

  int degree_;
  std::size_t size_, columns_ = 0;
  double area_;
  Vec2 middle_, half_;  ///< of the box
  Numbers wanted_, missing_, change_;
  std::vector<WeightedPoint> rule_;
};

/// The rule in the coordinates of the frame; empty where the iteration does not end.
std::vector<WeightedPoint> search(const Polygon& polygon, int degree) {
  constexpr int most_moves = 60;
  constexpr double points_of_moment = 0.4, nearly = 1e-10;
  const double moments = 0.5 * (degree + 1) * (degree + 2);
  const double groups = std::ceil(points_of_moment * moments / lane_count);
  Search search(polygon, degree);
  search.start(static_cast<std::size_t>(groups) * lane_count);
  double missing = search.look();
  for (int moves = 0; moves < most_moves; ++moves) {
    if (!search.move()) return {};
    const double before = std::exchange(missing, search.look());
    // To the last digits: when a move makes it no better.
    if (missing <= nearly && missing > 0.25 * before) return search.rule();
  }
  return {};
}

}  // namespace

std::vector<WeightedPoint> compact_rule(const Polygon& polygon, int degree) {
  constexpr int highest = 12;
  if (degree > 1 && degree <= highest) {
    const Frame frame(polygon);
    std::vector<WeightedPoint> rule = search(frame.coordinates(polygon), degree);
    for (WeightedPoint& w : rule) w = {frame.point(w.point), frame.determinant() * w.weight};
    if (!rule.empty()) return rule;
  }
  return polygon_rule(polygon, degree);
}

}  // namespace keyblock
