#pragma once
#include <cmath>

#include "linalg/block_solver.h"

/// Dense kernels on blocks stored by columns with padded rows. Every lane is computed on its own and sums run
/// in a fixed order, so that any instruction set gives the same bits.
namespace keyblock::linalg {

using Lanes = double __attribute__((vector_size(row_padding * sizeof(double)), aligned(8)));

inline Lanes load(const double* p) {
  return *reinterpret_cast<const Lanes*>(p);
}
inline void store(double* p, Lanes v) {
  *reinterpret_cast<Lanes*>(p) = v;
}

/// C −= A Bᵀ; A: rows × k, B: columns × k, C: rows × columns; `lanes` registers per column of A and C.
inline void subtract_product(int lanes, int columns, int k, const double* a, const double* b, int b_stride,
                             double* c) {
  const int stride = lanes * row_padding;
  for (int l = 0; l < lanes; ++l) {
    const double* a_lane = a + l * row_padding;
    double* c_lane = c + l * row_padding;
    for (int j = 0; j < columns; ++j) {
      Lanes sum = load(c_lane + j * stride);
      for (int q = 0; q < k; ++q) sum -= load(a_lane + q * stride) * b[q * b_stride + j];
      store(c_lane + j * stride, sum);
    }
  }
}

/// The same for blocks of order 1 (6 × 6 unknowns), all dimensions known.
inline void subtract_product_6(const double* a, const double* b, double* c) {
  const Lanes a0 = load(a), a1 = load(a + 8), a2 = load(a + 16), a3 = load(a + 24), a4 = load(a + 32),
              a5 = load(a + 40);
  for (int j = 0; j < 6; ++j) {
    Lanes sum = load(c + 8 * j);
    sum -= a0 * b[j];
    sum -= a1 * b[8 + j];
    sum -= a2 * b[16 + j];
    sum -= a3 * b[24 + j];
    sum -= a4 * b[32 + j];
    sum -= a5 * b[40 + j];
    store(c + 8 * j, sum);
  }
}

/// A = L Lᵀ in place (lower triangle), with 1/L_jj in `inverse`. False when a pivot is not positive.
inline bool factor_dense(int n, double* a, double* inverse) {
  const int stride = padded_rows(n);
  for (int j = 0; j < n; ++j) {
    double* column = a + j * stride;
    if (!(column[j] > 0.0)) return false;
    const double pivot = std::sqrt(column[j]);
    inverse[j] = 1.0 / pivot;
    column[j] = pivot;
    for (int i = j + 1; i < n; ++i) column[i] *= inverse[j];
    for (int q = j + 1; q < n; ++q) {
      double* target = a + q * stride;
      for (int i = q; i < n; ++i) target[i] -= column[i] * column[q];
    }
  }
  return true;
}

/// X ← X L⁻ᵀ for a block X of `lanes` registers per column.
inline void solve_right(int lanes, int n, const double* l, const double* inverse, double* x) {
  const int stride = lanes * row_padding, l_stride = padded_rows(n);
  for (int lane = 0; lane < lanes; ++lane) {
    double* x_lane = x + lane * row_padding;
    for (int j = 0; j < n; ++j) {
      Lanes sum = load(x_lane + j * stride);
      for (int q = 0; q < j; ++q) sum -= load(x_lane + q * stride) * l[q * l_stride + j];
      store(x_lane + j * stride, sum * inverse[j]);
    }
  }
}

/// y −= A x.
inline void subtract_times(int lanes, int columns, const double* a, const double* x, double* y) {
  const int stride = lanes * row_padding;
  for (int l = 0; l < lanes; ++l) {
    Lanes sum = load(y + l * row_padding);
    for (int j = 0; j < columns; ++j) sum -= load(a + j * stride + l * row_padding) * x[j];
    store(y + l * row_padding, sum);
  }
}

/// y −= Aᵀ x.
inline void subtract_transposed_times(int lanes, int columns, const double* a, const double* x, double* y) {
  const int stride = lanes * row_padding;
  for (int j = 0; j < columns; ++j) {
    Lanes sum = load(a + j * stride) * load(x);
    for (int l = 1; l < lanes; ++l) sum += load(a + j * stride + l * row_padding) * load(x + l * row_padding);
    y[j] -= ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
  }
}

}  // namespace keyblock::linalg
