#include "block/basis.h"

#include <cmath>
#include <stdexcept>

namespace keyblock::block {

namespace {

/// P_0 … P_n and their derivatives at t.
void legendre_1d(double t, int n, double* p, double* dp) {
  p[0] = 1.0;
  dp[0] = 0.0;
  if (n == 0) return;
  p[1] = t;
  dp[1] = 1.0;
  for (int k = 2; k <= n; ++k) {
    p[k] = ((2 * k - 1) * t * p[k - 1] - (k - 1) * p[k - 2]) / k;
    dp[k] = dp[k - 2] + (2 * k - 1) * p[k - 1];
  }
}

/// Of an n × n matrix, by rows.
std::size_t entry(int i, int j, int n) {
  return static_cast<std::size_t>(i) * static_cast<std::size_t>(n) + static_cast<std::size_t>(j);
}

}  // namespace

Basis::Basis(const Polygon& region, int order) : order_(order), size_(basis_size(order)) {
  if (order < 1) throw std::invalid_argument("a displacement polynomial has order 1 or higher");
  if (!(area(region) > 0.0)) throw std::invalid_argument("a block needs an area");
  const Box box = bounds(region);
  centre_ = 0.5 * (box.min + box.max);
  half_size_ = 0.5 * box.size();
  coefficient_.assign(static_cast<std::size_t>(size_) * static_cast<std::size_t>(size_), 0.0);
  for (int i = 0; i < size_; ++i) coefficient_[entry(i, i, size_)] = 1.0;
  const std::vector<WeightedPoint> rule = polygon_rule(region, 2 * order);
  orthonormalize(rule);
  orthonormalize(rule);

  identity_.assign(static_cast<std::size_t>(size_), Vec2{});
  std::vector<double> phi(static_cast<std::size_t>(size_));
  for (const WeightedPoint& w : rule) {
    evaluate(w.point, phi.data());
    for (std::size_t k = 0; k < 3; ++k) identity_[k] += w.weight * phi[k] * w.point;
  }
}

void Basis::legendre(Vec2 point, double* value, Vec2* gradient) const {
  std::vector<double> px(static_cast<std::size_t>(order_) + 1), dx(px), py(px), dy(px);
  legendre_1d((point.x - centre_.x) / half_size_.x, order_, px.data(), dx.data());
  legendre_1d((point.y - centre_.y) / half_size_.y, order_, py.data(), dy.data());
  std::size_t k = 0;
  for (std::size_t degree = 0; degree <= static_cast<std::size_t>(order_); ++degree) {
    for (std::size_t j = 0; j <= degree; ++j, ++k) {
      const std::size_t i = degree - j;
      if (value != nullptr) value[k] = px[i] * py[j];
      if (gradient != nullptr) gradient[k] = {dx[i] * py[j] / half_size_.x, px[i] * dy[j] / half_size_.y};
    }
  }
}

// With Gram matrix G = R Rᵀ of the present functions, R⁻¹ times them is orthonormal.
void Basis::orthonormalize(const std::vector<WeightedPoint>& rule) {
  std::vector<double> gram(coefficient_.size(), 0.0), phi(static_cast<std::size_t>(size_));
  for (const WeightedPoint& w : rule) {
    evaluate(w.point, phi.data());
    for (int i = 0; i < size_; ++i) {
      const double weighted = w.weight * phi[static_cast<std::size_t>(i)];
      for (int j = 0; j <= i; ++j) gram[entry(i, j, size_)] += weighted * phi[static_cast<std::size_t>(j)];
    }
  }
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = gram[entry(i, j, size_)];
      for (int k = 0; k < j; ++k) sum -= gram[entry(i, k, size_)] * gram[entry(j, k, size_)];
      // A polynomial that is the sum of those before it but for rounding: the region is too thin for the order.
      if (i == j && !(sum > 0.0)) throw std::invalid_argument("Basis: the order is too high for the region");
      gram[entry(i, j, size_)] = i == j ? std::sqrt(sum) : sum / gram[entry(j, j, size_)];
    }
  }
  // Forward substitution, row by row: coefficient ← R⁻¹ coefficient.
  for (int i = 0; i < size_; ++i) {
    for (int column = 0; column <= i; ++column) {
      double sum = coefficient_[entry(i, column, size_)];
      for (int k = column; k < i; ++k)
        sum -= gram[entry(i, k, size_)] * coefficient_[entry(k, column, size_)];
      coefficient_[entry(i, column, size_)] = sum / gram[entry(i, i, size_)];
    }
  }
}

void Basis::evaluate(Vec2 point, double* phi) const {
  std::vector<double> p(static_cast<std::size_t>(size_));
  legendre(point, p.data(), nullptr);
  for (int i = 0; i < size_; ++i) {
    double sum = 0.0;
    for (int j = 0; j <= i; ++j) sum += coefficient_[entry(i, j, size_)] * p[static_cast<std::size_t>(j)];
    phi[i] = sum;
  }
}

void Basis::gradients(Vec2 point, Vec2* gradient) const {
  std::vector<Vec2> p(static_cast<std::size_t>(size_));
  legendre(point, nullptr, p.data());
  for (int i = 0; i < size_; ++i) {
    Vec2 sum;
    for (int j = 0; j <= i; ++j) sum += coefficient_[entry(i, j, size_)] * p[static_cast<std::size_t>(j)];
    gradient[i] = sum;
  }
}

std::vector<Vec2> Basis::identity() const {
  return identity_;
}

}  // namespace keyblock::block
