#pragma once
#include <cmath>

#include "core/lanes.h"
#include "linalg/block_solver.h"
#include "linalg/registers.h"

/// Dense kernels on blocks stored by columns with padded rows, the padding zero. Every lane is computed on its own, sums run in
/// a fixed order and products are fused with sums by name, so that any instruction set gives the same bits.
namespace keyblock::linalg {

/// Calls columns<width>(c), six columns at a time and then one by one.
template <typename Columns>
void in_sixes(int size, const Columns& columns) {
  int c = 0;
  for (; c + 6 <= size; c += 6) columns.template operator()<6>(c);
  for (; c < size; ++c) columns.template operator()<1>(c);
}

/// C −= A Bᵀ for `lanes` registers of rows and `columns` columns of C, all held in registers; A: rows × k, B: columns × k.
template <int lanes, int columns, typename Number>
void subtract_tile(int k, const Number* a, int a_stride, const Number* b, int b_stride, Number* c,
                   int c_stride) {
  decltype(load(a)) t[columns][lanes];
#pragma GCC unroll 8
  for (int j = 0; j < columns; ++j) {
#pragma GCC unroll 4
    for (int l = 0; l < lanes; ++l) t[j][l] = load(c + j * c_stride + l * row_padding);
  }
  for (int q = 0; q < k; ++q) {
    decltype(load(a)) x[lanes];
#pragma GCC unroll 4
    for (int l = 0; l < lanes; ++l) x[l] = -load(a + q * a_stride + l * row_padding);
#pragma GCC unroll 8
    for (int j = 0; j < columns; ++j) {
      const auto y = broadcast(b[q * b_stride + j]);
#pragma GCC unroll 4
      for (int l = 0; l < lanes; ++l) t[j][l] = add_product(x[l], y, t[j][l]);
    }
  }
#pragma GCC unroll 8
  for (int j = 0; j < columns; ++j) {
#pragma GCC unroll 4
    for (int l = 0; l < lanes; ++l) store(c + j * c_stride + l * row_padding, t[j][l]);
  }
}

/// C −= A Bᵀ of blocks: A: rows × k, B: columns × k, C: rows × columns; `lanes` registers per column of A and C.
template <typename Number>
void subtract_block_product(int lanes, int columns, int k, const Number* a, const Number* b, int b_stride,
                            Number* c) {
  const int stride = lanes * row_padding;
  const auto rows = [&]<int width>(int j) {
    const Number* b_j = b + j;
    Number* c_j = c + j * stride;
    int l = 0;
    for (; l + 4 <= lanes; l += 4)
      subtract_tile<4, width>(k, a + l * row_padding, stride, b_j, b_stride, c_j + l * row_padding, stride);
    const Number* a_l = a + l * row_padding;
    Number* c_l = c_j + l * row_padding;
    if (lanes - l == 1) subtract_tile<1, width>(k, a_l, stride, b_j, b_stride, c_l, stride);
    if (lanes - l == 2) subtract_tile<2, width>(k, a_l, stride, b_j, b_stride, c_l, stride);
    if (lanes - l == 3) subtract_tile<3, width>(k, a_l, stride, b_j, b_stride, c_l, stride);
  };
  int j = 0;
  for (; j + 6 <= columns; j += 6) rows.template operator()<6>(j);
  for (; j + 2 <= columns; j += 2) rows.template operator()<2>(j);
  if (j < columns) rows.template operator()<1>(j);
}

/// The same for blocks of n rows and columns, n a multiple of 6.
template <int n, typename Number>
void subtract_block_product(const Number* a, const Number* b, Number* c) {
  constexpr int stride = padded_rows(n);
  using Of = Registers<Number, stride>;
  using Register = typename Of::Register;
  constexpr int width = sizeof(Register) / sizeof(Number), lanes = stride / width, columns = 6;
  for (int j = 0; j < n; j += columns) {
    Register t[columns][lanes];
#pragma GCC unroll 6
    for (int i = 0; i < columns; ++i) {
#pragma GCC unroll 2
      for (int l = 0; l < lanes; ++l) t[i][l] = Of::load_from(c + (j + i) * stride + l * width);
    }
#pragma GCC unroll 12
    for (int q = 0; q < n; ++q) {
#pragma GCC unroll 2
      for (int l = 0; l < lanes; ++l) {
        const auto x = -Of::load_from(a + q * stride + l * width);
#pragma GCC unroll 6
        for (int i = 0; i < columns; ++i) t[i][l] = add_product(x, Of::all(b[q * stride + j + i]), t[i][l]);
      }
    }
#pragma GCC unroll 6
    for (int i = 0; i < columns; ++i) {
#pragma GCC unroll 2
      for (int l = 0; l < lanes; ++l) Of::store_to(c + (j + i) * stride + l * width, t[i][l]);
    }
  }
}

/// C −= A Bᵀ and D −= E Bᵀ for blocks of n columns and padded rows that fill half a register; the blocks A and E follow each other.
template <int n>
void subtract_two_block_products(const float* a_and_e, const float* b, float* c, float* d) {
  constexpr int stride = padded_rows(n);
#if defined(__AVX512F__)
  static_assert(stride == 8);
  const auto load_two = [](const float* p, const float* q) {
    return __builtin_shufflevector(load(p), load(q), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  };
  SixteenLanes t[n];
#pragma GCC unroll 6
  for (int i = 0; i < n; ++i) t[i] = load_two(c + i * stride, d + i * stride);
#pragma GCC unroll 6
  for (int q = 0; q < n; ++q) {
    const SixteenLanes x = -load_two(a_and_e + q * stride, a_and_e + (n + q) * stride);
#pragma GCC unroll 6
    for (int i = 0; i < n; ++i) t[i] = add_product(x, SixteenLanes(_mm512_set1_ps(b[q * stride + i])), t[i]);
  }
#pragma GCC unroll 6
  for (int i = 0; i < n; ++i) {
    store(c + i * stride, __builtin_shufflevector(t[i], t[i], 0, 1, 2, 3, 4, 5, 6, 7));
    store(d + i * stride, __builtin_shufflevector(t[i], t[i], 8, 9, 10, 11, 12, 13, 14, 15));
  }
#else
  subtract_block_product<n>(a_and_e, b, c);
  subtract_block_product<n>(a_and_e + n * stride, b, d);
#endif
}

/// A = U D Uᵀ, U with a diagonal of ones, of the lower triangle: D U below the diagonal, and D⁻¹ into `scale`. False when a pivot is not
/// positive.
inline bool factor_without_roots(int n, double* a, double* scale) {
  const int stride = padded_rows(n);
  for (int j = 0; j < n; ++j) {
    const double* column = a + j * stride;
    if (!(column[j] > 0.0)) return false;
    const double inverse = 1.0 / column[j];
    scale[j] = inverse;
    for (int q = j + 1; q < n; ++q) {
      const Lanes factor = broadcast(column[q] * inverse);
      double* target = a + q * stride;
      for (int l = q / row_padding * row_padding; l < stride; l += row_padding)
        store(target + l, subtract_product(load(column + l), factor, load(target + l)));
    }
  }
  return true;
}

/// U⁻¹ in place of the columns D U, the upper triangle zero; column by column from the right.
inline void invert_unit_triangle(int n, double* a, const double* scale) {
  const int stride = padded_rows(n);
  for (int j = 0; j < n; ++j) {
    double* column = a + j * stride;
    for (int i = 0; i < j; ++i) column[i] = 0.0;
    for (int i = j + 1; i < n; ++i) column[i] *= scale[j];
    column[j] = 1.0;
  }
  for (int j = n - 1; j >= 0; --j) {
    double* column = a + j * stride;
    for (int q = n - 1; q > j; --q) {
      const Lanes factor = broadcast(column[q]);
      // Column q of U⁻¹ begins with a one in row q.
      column[q] = 0.0;
      for (int l = q / row_padding * row_padding; l < stride; l += row_padding)
        store(column + l, subtract_product(load(a + q * stride + l), factor, load(column + l)));
    }
  }
}

/// Replaces a symmetric positive definite block A = L Lᵀ (lower triangle) by L⁻¹ (its upper triangle zero). False when a pivot is
/// not positive. By A = U D Uᵀ: then no root is waited for.
inline bool invert_factor(int n, double* a, double* scale) {
  const int stride = padded_rows(n);
  if (!factor_without_roots(n, a, scale)) return false;
  invert_unit_triangle(n, a, scale);
  for (int i = 0; i < n; ++i) scale[i] = std::sqrt(scale[i]);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) a[j * stride + i] *= scale[i];
  }
  return true;
}

/// The same for blocks of n unknowns, held in registers: one function, as the compiler keeps them there within one only.
template <int n>
bool invert_factor(double* a) {  // NOLINT(readability-function-cognitive-complexity): loops that are unrolled
  constexpr int stride = padded_rows(n);
  using Of = Registers<double, stride>;
  using Register = typename Of::Register;
  constexpr int width = sizeof(Register) / sizeof(double), lanes = stride / width;
  Register first{}, column[n][lanes], scale[lanes]{};
  for (int k = 0; k < width; ++k) first[k] = k;
#pragma GCC unroll 12
  for (int j = 0; j < n; ++j) {
#pragma GCC unroll 4
    for (int l = 0; l < lanes; ++l) column[j][l] = Of::load_from(a + j * stride + l * width);
  }
  const auto entry = [&](int row, int j) { return column[j][row / width][row % width]; };
#pragma GCC unroll 12
  for (int j = 0; j < n; ++j) {
    const double pivot = entry(j, j);
    if (!(pivot > 0.0)) return false;
    const double inverse = 1.0 / pivot;
    scale[j / width][j % width] = inverse;
#pragma GCC unroll 12
    for (int q = j + 1; q < n; ++q) {
      const Register factor = Of::all(entry(q, j) * inverse);
#pragma GCC unroll 4
      for (int l = q / width; l < lanes; ++l)
        column[q][l] = subtract_product(column[j][l], factor, column[q][l]);
    }
  }
#pragma GCC unroll 12
  for (int j = 0; j < n; ++j) {
    const Register factor = Of::all(scale[j / width][j % width]);
#pragma GCC unroll 4
    for (int l = 0; l < lanes; ++l) {
      const Register row = first + Of::all(l * width - j);
      column[j][l] = row > 0.0 ? column[j][l] * factor : row == 0.0 ? Of::all(1.0) : Register{};
    }
  }
#pragma GCC unroll 12
  for (int j = n - 1; j >= 0; --j) {
#pragma GCC unroll 12
    for (int q = n - 1; q > j; --q) {
      const Register factor = Of::all(entry(q, j));
      column[j][q / width][q % width] = 0.0;
#pragma GCC unroll 4
      for (int l = q / width; l < lanes; ++l)
        column[j][l] = subtract_product(column[q][l], factor, column[j][l]);
    }
  }
#pragma GCC unroll 4
  for (int l = 0; l < lanes; ++l) {
    for (int k = 0; k < width; ++k) scale[l][k] = std::sqrt(scale[l][k]);
#pragma GCC unroll 12
    for (int j = 0; j < n; ++j) Of::store_to(a + j * stride + l * width, column[j][l] * scale[l]);
  }
  return true;
}

/// X ← X L⁻ᵀ for a block X of `lanes` registers per column; inverse: L⁻¹ by columns.
template <typename Number>
void multiply_right(int lanes, int n, const Number* inverse, Number* x) {
  const int stride = lanes * row_padding, l_stride = padded_rows(n);
  for (int lane = 0; lane < lanes; ++lane) {
    Number* x_lane = x + lane * row_padding;
    for (int j = n - 1; j >= 0; --j) {
      auto t = load(x_lane + j * stride) * inverse[j * l_stride + j];
      for (int q = 0; q < j; ++q)
        t = add_product(load(x_lane + q * stride), broadcast(inverse[q * l_stride + j]), t);
      store(x_lane + j * stride, t);
    }
  }
}
/// The same for blocks of n columns and rows, held in registers.
template <int n, typename Number>
void multiply_right(const Number* inverse, Number* x) {
  constexpr int stride = padded_rows(n);
  using Of = Registers<Number, stride>;
  using Register = typename Of::Register;
  constexpr int width = sizeof(Register) / sizeof(Number);
  for (int l = 0; l < stride; l += width) {
    Register column[n];
#pragma GCC unroll 12
    for (int q = 0; q < n; ++q) column[q] = Of::load_from(x + q * stride + l);
#pragma GCC unroll 12
    for (int j = n - 1; j >= 0; --j) {
      column[j] = column[j] * inverse[j * stride + j];
#pragma GCC unroll 12
      for (int q = 0; q < j; ++q)
        column[j] = add_product(column[q], Of::all(inverse[q * stride + j]), column[j]);
    }
#pragma GCC unroll 12
    for (int q = 0; q < n; ++q) Of::store_to(x + q * stride + l, column[q]);
  }
}

/// y = A x; y and x are not the same.
template <typename Stored, typename Number>
void multiply(int lanes, int columns, const Stored* a, const Number* x, Number* y) {
  using Of = Registers<Number, row_padding>;
  constexpr int width = sizeof(typename Of::Register) / sizeof(Number);
  const int stride = lanes * row_padding;
  for (int l = 0; l < stride; l += width) {
    typename Of::Register t{};
    for (int j = 0; j < columns; ++j) t = add_product(Of::load_from(a + j * stride + l), Of::all(x[j]), t);
    Of::store_to(y + l, t);
  }
}

/// y −= A x.
template <typename Stored, typename Number>
void subtract_times(int lanes, int columns, const Stored* a, const Number* x, Number* y) {
  using Of = Registers<Number, row_padding>;
  constexpr int width = sizeof(typename Of::Register) / sizeof(Number);
  const int stride = lanes * row_padding;
  for (int l = 0; l < stride; l += width) {
    auto t = Of::load_from(y + l);
    for (int j = 0; j < columns; ++j)
      t = subtract_product(Of::load_from(a + j * stride + l), Of::all(x[j]), t);
    Of::store_to(y + l, t);
  }
}

/// y −= A x as subtract_times() does, of two pairs of y and x and blocks A of n columns, up to eight rows; the x stay in registers.
template <int n>
class TwoFactors {
 public:
  TwoFactors(const double* x, const double* other) {
    for (int j = 0; j < n; ++j) {
      x_[j] = Of::all(x[j]);
      other_[j] = Of::all(other[j]);
    }
  }
  template <typename Stored>
  void subtract_product(const Stored* a, double* y, double* other) const {
    for (int l = 0; l < row_padding; l += width) {
      Register t = Of::load_from(y + l), s = Of::load_from(other + l);
#pragma GCC unroll 12
      for (int j = 0; j < n; ++j) {
        const Register column = Of::load_from(a + j * row_padding + l);
        t = linalg::subtract_product(column, x_[j], t);
        s = linalg::subtract_product(column, other_[j], s);
      }
      Of::store_to(y + l, t);
      Of::store_to(other + l, s);
    }
  }

 private:
  using Of = Registers<double, row_padding>;
  using Register = typename Of::Register;
  static constexpr int width = sizeof(Register) / sizeof(double);
  Register x_[n], other_[n];
};

/// t_j += A_j ∘ x, the products of column j of A with x lane by lane; their sum is (Aᵀ x)_j. As many columns as t has.
template <typename Stored, typename Number, typename Products, int columns>
void add_lane_products(int lanes, const Stored* a, const Number* x, Products (&t)[columns]) {
  const int stride = lanes * row_padding;
  for (int l = 0; l < stride; l += row_padding) {
#pragma GCC unroll 8
    for (int j = 0; j < columns; ++j) add_lane_product(a + j * stride + l, x + l, t[j]);
  }
}

/// y −= Bᵀ x, of a block whose columns have `stride` numbers; y_stride: those of y.
inline void subtract_transposed(const double* block, int stride, int columns, const double* x, int y_stride,
                                double* y) {
  in_sixes(columns, [&]<int width>(int c) {
    Lanes t[width]{};
    add_lane_products(stride / row_padding, block + c * stride, x, t);
    subtract_first<width>(y + c, y_stride - c, sums(t));
  });
}

}  // namespace keyblock::linalg
