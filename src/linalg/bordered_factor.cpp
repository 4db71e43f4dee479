#include "linalg/bordered_factor.h"

#include <cmath>

namespace keyblock::linalg {

namespace {

/// t_q −= Σ_k a_k b_kq for four columns q; a by registers, b by eight numbers.
void subtract_products(std::size_t count, const double* a, const double* b, Lanes (&t)[4]) {
  for (std::size_t k = 0; k < count; ++k, a += lane_count, b += lane_count) {
    const Lanes x = -load(a);
#pragma GCC unroll 4
    for (int q = 0; q < 4; ++q) t[q] = add_product(x, broadcast(b[q]), t[q]);
  }
}

}  // namespace

/// What the rows of group g have in the columns of group h: L D into scaled_, L in their place.
void BorderedFactor::eliminate(std::size_t g, std::size_t h) {
  const std::size_t first = h * width;
  double* scaled = &scaled_[first * width];
  for (std::size_t q = 0; q < width; q += 4) {
    Lanes t[4];
    for (std::size_t p = 0; p < 4; ++p) t[p] = load(column(g, first + q + p));
    subtract_products(first + q, scaled_.data(), column(h, 0) + q, t);
    for (std::size_t p = 0; p < 4; ++p) {
      for (std::size_t k = 0; k < p; ++k)
        t[p] = subtract_product(t[k], broadcast(column(h, first + q + k)[q + p]), t[p]);
      store(scaled + (q + p) * width, t[p]);
      store(column(g, first + q + p), inverse_[first + q + p] * t[p]);
    }
  }
}

/// The block on the diagonal of group g.
bool BorderedFactor::factor_diagonal(std::size_t g) {
  const std::size_t first = g * width;
  Lanes t[width];
  for (std::size_t q = 0; q < width; q += 4) {
    Lanes some[4];
    for (std::size_t p = 0; p < 4; ++p) some[p] = load(column(g, first + q + p));
    subtract_products(first, scaled_.data(), column(g, 0) + q, some);
    for (std::size_t p = 0; p < 4; ++p) t[q + p] = some[p];
  }
  for (std::size_t q = 0; q < width; ++q) {
    const double pivot = t[q][q];
    if (pivot == 0.0 || !std::isfinite(pivot)) return false;
    const double inverse = inverse_[first + q] = 1.0 / pivot;
    const Lanes unit = inverse * t[q];
    store(column(g, first + q), unit);
    for (std::size_t p = q + 1; p < width; ++p) t[p] = subtract_product(t[q], broadcast(unit[p]), t[p]);
  }
  return true;
}

void BorderedFactor::solve(std::span<double> x) {
  const std::size_t groups = (size_ + width - 1) / width;
  right_.assign(groups * width, 0.0);
  std::copy(x.begin(), x.end(), right_.begin());
  for (std::size_t g = 0; g < groups; ++g) {
    const std::size_t first = g * width;
    Lanes t = load(&right_[first]), other{};
    for (std::size_t k = 0; k < first; k += 2) {
      t = subtract_product(load(column(g, k)), broadcast(right_[k]), t);
      other = subtract_product(load(column(g, k + 1)), broadcast(right_[k + 1]), other);
    }
    t += other;
    store(&right_[first], t);
    for (std::size_t q = 0; q < width; ++q) {
      const double* below = column(g, first + q);
      for (std::size_t r = q + 1; r < width; ++r) right_[first + r] -= below[r] * right_[first + q];
    }
  }
  for (std::size_t i = 0; i < right_.size(); ++i) right_[i] *= inverse_[i];
  for (std::size_t g = groups; g-- > 0;) {
    const std::size_t first = g * width;
    for (std::size_t q = width; q-- > 0;) {
      const double* below = column(g, first + q);
      for (std::size_t r = q + 1; r < width; ++r) right_[first + q] -= below[r] * right_[first + r];
    }
    const Lanes solved = load(&right_[first]);
    for (std::size_t k = 0; k < first; k += width) {
      Lanes t[width];
      for (std::size_t q = 0; q < width; ++q) t[q] = load(column(g, k + q)) * solved;
      store(&right_[k], load(&right_[k]) - sums(t));
    }
  }
  std::copy_n(right_.begin(), x.size(), x.begin());
}

void add_multiple(double scale, const double* row, std::size_t n, double* out) {
  for (std::size_t k = 0; k < n; k += lane_count)
    store(out + k, add_product(broadcast(scale), load(row + k), load(out + k)));
}

}  // namespace keyblock::linalg
