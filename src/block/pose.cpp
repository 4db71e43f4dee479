#include "block/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/index.h"
#include "core/known_size.h"
#include "core/lanes.h"

namespace keyblock::block {

void rotation(double w, double& cosine, double& sine) {
  if (std::isinf(w)) w = std::numeric_limits<double>::quiet_NaN();  // halves of it stay as large
  int halvings = 0;
  while (std::abs(w) > 0.125) {
    w *= 0.5;
    ++halvings;
  }
  const double w2 = w * w;
  // versine = 1 − cos w keeps its digits through the doublings: 1 − cos 2w = 2 sin² w.
  double versine = w2 * (1.0 / 2 - w2 * (1.0 / 24 - w2 * (1.0 / 720 - w2 * (1.0 / 40320 - w2 / 3628800))));
  sine =
      w * (1.0 - w2 * (1.0 / 6 - w2 * (1.0 / 120 - w2 * (1.0 / 5040 - w2 * (1.0 / 362880 - w2 / 39916800)))));
  for (; halvings > 0; --halvings) {
    const double doubled = 2.0 * sine * (1.0 - versine);
    versine = 2.0 * sine * sine;
    sine = doubled;
  }
  cosine = 1.0 - versine;
  // One Newton step towards cos² + sin² = 1, so that rotations do not grow or shrink areas over many steps.
  const double correction = 0.5 * (3.0 - (cosine * cosine + sine * sine));
  cosine *= correction;
  sine *= correction;
}

namespace {

/// To whole lanes.
int padded(int n) {
  return (n + lane_count - 1) / lane_count * lane_count;
}

/// x and y of a block's coefficients from `first` on, as many as there are lanes; zero beyond its `size`.
struct Coefficients {
  Lanes x, y;
  Coefficients(const double* a, int first, int size) {
    const int left = 2 * (size - first);
    const Lanes low = load_first(a + 2 * first, std::min(left, lane_count)),
                high = left > lane_count
                           ? load_first(a + 2 * first + lane_count, std::min(left - lane_count, lane_count))
                           : Lanes{};
    x = even_lanes(low, high);
    y = odd_lanes(low, high);
  }
};

}  // namespace

Pose::Pose(const Polygon& region, const Basis& basis) : size_(basis.size()) {
  const std::size_t n = at(size_ - 1), stride = at(padded(size_ - 1));
  std::vector<Vec2> g(at(size_));
  w_.assign(n * stride, 0.0);
  const int degree = 2 * (basis.order() - 1);
  for (const WeightedPoint& point : polygon_rule(region, degree)) {
    basis.gradients(point.point, g.data());
    for (std::size_t l = 0; l < n; ++l) {
      for (std::size_t k = 0; k < n; ++k) w_[l * stride + k] += point.weight * cross(g[k + 1], g[l + 1]);
    }
  }
  w12_ = w_[stride];
  if (size_ == 3) w_ = {};
}

Pose::Sums Pose::sums(const double* d, const double* a) const {
  if (size_ == 3)
    return {w12_ * (a[2] * a[5] - a[4] * a[3]),
            w12_ * (d[2] * a[4] + d[3] * a[5] - d[4] * a[2] - d[5] * a[3])};
  Sums sums;
  with_known_size(size_, [&](auto size) {
    const int n = size - 1, stride = padded(n);
    for (int first = 0; first < n; first += lane_count) {
      Lanes x{}, y{};  // W a
      for (int l = 0; l < n; ++l) {
        const Lanes column = load(&w_[at(l * stride + first)]);
        x += column * broadcast(a[2 * l + 2]);
        y += column * broadcast(a[2 * l + 3]);
      }
      const Coefficients of_a(a, first + 1, size), of_d(d, first + 1, size);
      sums.area += 0.5 * sum(of_a.x * y - of_a.y * x);
      sums.curl += sum(of_d.x * x + of_d.y * y);
    }
  });
  return sums;
}

double Pose::area(const double* a) const {
  return sums(a, a).area;
}

double Pose::mean_spin(const double* increment, const double* a) const {
  const Sums of = sums(increment, a);
  return 0.5 * of.curl / of.area;
}

void Pose::update(double w, const double* increment, double* a, double* v) const {
  double c, s;
  rotation(w, c, s);
  a[0] += increment[0];
  a[1] += increment[1];
  for (int k = 1; k < size_; ++k) {
    const double x = a[2 * k], y = a[2 * k + 1];
    const double px = x + increment[2 * k] + w * y, py = y + increment[2 * k + 1] - w * x;
    a[2 * k] = c * px - s * py;
    a[2 * k + 1] = s * px + c * py;
    const double vx = v[2 * k], vy = v[2 * k + 1];
    v[2 * k] = c * vx - s * vy;
    v[2 * k + 1] = s * vx + c * vy;
  }
}

void Pose::rotate(double w, double* u) const {
  double c, s;
  rotation(w, c, s);
  for (int k = 1; k < size_; ++k) {
    const double x = u[2 * k], y = u[2 * k + 1];
    u[2 * k] = c * x - s * y;
    u[2 * k + 1] = s * x + c * y;
  }
}

}  // namespace keyblock::block
