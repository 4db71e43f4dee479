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
  std::vector<Vec2> g(at(size_));
  w_.assign(at((size_ - 1) * (size_ - 2) / 2), 0.0);
  const int degree = 2 * (basis.order() - 1);
  for (const WeightedPoint& point : polygon_rule(region, degree)) {
    basis.gradients(point.point, g.data());
    double* w = w_.data();
    for (std::size_t k = 1; k < g.size(); ++k) {
      for (std::size_t l = k + 1; l < g.size(); ++l) *w++ += point.weight * cross(g[k], g[l]);
    }
  }
  w12_ = w_[0];
}

template <typename Of>
double Pose::sum_of_pairs(const Of& of) const {
  if (size_ == 3) return w12_ * of(1, 2);
  double sum = 0.0;
  with_known_size(size_, [&](auto size) {
    const double* w = w_.data();
    for (int k = 1; k < size; ++k) {
      for (int l = k + 1; l < size; ++l) sum += *w++ * of(k, l);
    }
  });
  return sum;
}

double Pose::area(const double* a) const {
  return sum_of_pairs([&](int k, int l) { return a[2 * k] * a[2 * l + 1] - a[2 * l] * a[2 * k + 1]; });
}

double Pose::mean_spin(const double* increment, const double* a) const {
  const double curl = sum_of_pairs([&](int k, int l) {
    return increment[2 * k] * a[2 * l] + increment[2 * k + 1] * a[2 * l + 1] - increment[2 * l] * a[2 * k] -
           increment[2 * l + 1] * a[2 * k + 1];
  });
  return 0.5 * curl / area(a);
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
