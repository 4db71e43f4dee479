#include "block/pose.h"

#include <cmath>

#include "core/index.h"
#include "core/known_size.h"

namespace keyblock::block {

void rotation(double w, double& cosine, double& sine) {
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

Pose::Pose(const Polygon& region, const Basis& basis) : size_(basis.size()) {
  const auto n = static_cast<std::size_t>(size_);
  w_.assign(n * n, 0.0);
  std::vector<Vec2> g(n);
  const int degree = 2 * (basis.order() - 1);
  for (const WeightedPoint& w : thinned_rule(polygon_rule(region, degree), degree)) {
    basis.gradients(w.point, g.data());
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t l = 0; l < n; ++l) w_[k * n + l] += w.weight * cross(g[k], g[l]);
    }
  }
  w12_ = w_[n + 2];
}

double Pose::area(const double* a) const {
  if (size_ == 3) return w12_ * (a[2] * a[5] - a[4] * a[3]);
  double sum = 0.0;
  with_known_size(size_, [&](auto size) {
    for (int k = 1; k < size; ++k) {
      double row = 0.0;
      for (int l = 1; l < size; ++l) row += w_[at(k * size + l)] * a[2 * l + 1];
      sum += a[2 * k] * row;
    }
  });
  return sum;
}

double Pose::mean_spin(const double* increment, const double* a) const {
  if (size_ == 3) {
    const double curl = increment[2] * a[4] + increment[3] * a[5] - increment[4] * a[2] - increment[5] * a[3];
    return 0.5 * w12_ * curl / area(a);
  }
  double sum = 0.0, current_area = 0.0;
  with_known_size(size_, [&](auto size) {
    for (int k = 1; k < size; ++k) {
      const double* w = &w_[at(k * size)];
      double row_x = 0.0, row_y = 0.0;
      for (int l = 1; l < size; ++l) {
        row_x += w[l] * a[2 * l];
        row_y += w[l] * a[2 * l + 1];
      }
      sum += increment[2 * k] * row_x + increment[2 * k + 1] * row_y;
      current_area += a[2 * k] * row_y;
    }
  });
  return 0.5 * sum / current_area;
}

double Pose::update(const double* increment, double* a, double* v) const {
  const double w = mean_spin(increment, a);
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
  return w;
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
