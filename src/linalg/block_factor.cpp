#include "linalg/block_factor.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/index.h"
#include "linalg/block_kernels.h"

namespace keyblock::linalg {

namespace {

template <int equal>
int size_of(const BlockPattern& pattern, std::size_t column) {
  return equal > 0 ? equal : pattern.size[column];
}
template <int equal>
int stride_of(const BlockPattern& pattern, std::size_t column) {
  return equal > 0 ? padded_rows(equal) : pattern.stride[column];
}

/// What the matrix has over the pivot, the largest of a diagonal block. inverse: L⁻¹, with 1 / √pivot on its diagonal.
template <typename Number>
double largest_cancellation(int size, int stride, const double* block, const Number* inverse) {
  double largest = 0.0;
  for (int k = 0; k < size; ++k) {
    const double root = inverse[k * (stride + 1)];
    largest = std::max(largest, block[k * (stride + 1)] * root * root);
  }
  return largest;
}

/// Calls call.template operator()<equal>().
template <typename Call>
auto for_equal_size(const BlockPattern& pattern, const Call& call) {
  if (pattern.equal_size == 6) return call.template operator()<6>();
  if (pattern.equal_size == 12) return call.template operator()<12>();
  return call.template operator()<0>();
}

}  // namespace

template <typename Number>
BlockFactor<Number>::BlockFactor(const BlockPattern& pattern)
    : values_(pattern.values, Number{0}), stale_(pattern.columns(), 1), target_(pattern.columns(), nullptr) {
  const std::size_t n = pattern.columns();
  const std::size_t largest =
      n == 0 ? 0 : at(*std::max_element(pattern.stride.begin(), pattern.stride.end()));
  solved_.assign(largest, 0.0);
  scale_.assign(largest, 0.0);
  diagonal_.assign(largest * largest, 0.0);
}

template <typename Number>
void BlockFactor<Number>::make_stale() {
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
}

/// A_ij −= Σ_k L_ik L_jkᵀ for all rows i of column j.
template <typename Number>
template <int equal>
void BlockFactor<Number>::update_column(const BlockPattern& pattern, std::size_t j) {
  target_[j] = &values_[pattern.column_value[j]];
  for (std::size_t e = pattern.row_start[j]; e < pattern.row_start[j + 1]; ++e)
    target_[pattern.rows[e]] = &values_[pattern.row_value[e]];
  for (std::size_t u = pattern.update_start[j]; u < pattern.update_start[j + 1]; ++u) {
    const auto [k, first] = pattern.updates[u];
    const Number* l_jk = &values_[pattern.row_value[first]];
    std::size_t e = first;
    if constexpr (equal == 6 && std::is_same_v<Number, float>) {
      for (; e + 2 <= pattern.row_start[k + 1]; e += 2)
        subtract_two_block_products<equal>(&values_[pattern.row_value[e]], l_jk, target_[pattern.rows[e]],
                                           target_[pattern.rows[e + 1]]);
    }
    for (; e < pattern.row_start[k + 1]; ++e) {
      const std::size_t i = pattern.rows[e];
      if constexpr (equal > 0) {
        subtract_block_product<equal>(&values_[pattern.row_value[e]], l_jk, target_[i]);
      } else {
        subtract_block_product(pattern.stride[i] / row_padding, pattern.size[j], pattern.size[k],
                               &values_[pattern.row_value[e]], l_jk, pattern.stride[j], target_[i]);
      }
    }
  }
}

/// L_jj⁻¹ in place of A_jj, found in double precision. False when a pivot is not positive.
template <typename Number>
template <int equal>
bool BlockFactor<Number>::invert_diagonal(const BlockPattern& pattern, std::size_t j) {
  const int size = size_of<equal>(pattern, j), count = stride_of<equal>(pattern, j) * size;
  Number* block = &values_[pattern.column_value[j]];
  double* wide = nullptr;
  if constexpr (std::is_same_v<Number, double>) {
    wide = block;
  } else {
    wide = diagonal_.data();
    for (int k = 0; k < count; k += row_padding) store(wide + k, widen(load(block + k)));
  }
  if constexpr (equal > 0) {
    if (!invert_factor<equal>(wide)) return false;
  } else {
    if (!invert_factor(size, wide, scale_.data())) return false;
  }
  if constexpr (!std::is_same_v<Number, double>) {
    for (int k = 0; k < count; k += row_padding) store(block + k, narrow(load(wide + k)));
  }
  return true;
}

template <typename Number>
template <int equal>
FactorOutcome BlockFactor<Number>::factor_columns(const BlockPattern& pattern, const BlockMatrix& matrix,
                                                  double least_pivot) {
  for (std::size_t j = 0; j < pattern.columns(); ++j) {
    if (stale_[j] == 0) continue;
    // What is eliminated later depends on this column through its parent in the elimination tree.
    if (pattern.parent[j] != BlockPattern::none) stale_[pattern.parent[j]] = 1;
    matrix.load_column(pattern, j, std::span<Number>(values_));
    update_column<equal>(pattern, j);
    if (!invert_diagonal<equal>(pattern, j)) return FactorOutcome::not_positive;
    const int size = size_of<equal>(pattern, j), stride = stride_of<equal>(pattern, j);
    const Number* inverse = &values_[pattern.column_value[j]];
    if (least_pivot > 0.0 &&
        largest_cancellation(size, stride, matrix.diagonal_of_column(j), inverse) * least_pivot > 1.0)
      return FactorOutcome::poor;
    for (std::size_t e = pattern.row_start[j]; e < pattern.row_start[j + 1]; ++e) {
      Number* x = &values_[pattern.row_value[e]];
      if constexpr (equal > 0) {
        multiply_right<equal>(inverse, x);
      } else {
        multiply_right(pattern.stride[pattern.rows[e]] / row_padding, size, inverse, x);
      }
    }
    stale_[j] = 0;
  }
  return FactorOutcome::done;
}

template <typename Number>
FactorOutcome BlockFactor<Number>::factor(const BlockPattern& pattern, const BlockMatrix& matrix,
                                          double least_pivot) {
  return for_equal_size(pattern,
                        [&]<int equal>() { return factor_columns<equal>(pattern, matrix, least_pivot); });
}

/// y − Σ_i L_ijᵀ x_i for some unknowns of column j, from c on, into solved_. Returns their number.
template <typename Number>
template <int equal, int columns>
int BlockFactor<Number>::gather(const BlockPattern& pattern, std::size_t j, int c, const double* y) {
  Lanes t[columns]{};
  for (std::size_t e = pattern.row_start[j]; e < pattern.row_start[j + 1]; ++e) {
    const std::size_t i = pattern.rows[e];
    const int rows = stride_of<equal>(pattern, i);
    add_lane_products(rows / row_padding, &values_[pattern.row_value[e] + at(c * rows)],
                      y + pattern.work_start[i], t);
  }
  const double* y_j = y + pattern.work_start[j] + c;
  double* out = &solved_[at(c)];
  if constexpr (columns == 1) {
    out[0] = y_j[0] - sum(t[0]);
  } else {
    store_first<columns>(out, stride_of<equal>(pattern, j) - c, load(y_j) - sums(t));
  }
  return columns;
}

/// L_jj⁻ᵀ y likewise.
template <typename Number>
template <int equal, int columns>
int BlockFactor<Number>::divide(const BlockPattern& pattern, std::size_t j, int c, double* y) {
  Lanes t[columns]{};
  const int rows = stride_of<equal>(pattern, j);
  add_lane_products(rows / row_padding, &values_[pattern.column_value[j] + at(c * rows)], solved_.data(), t);
  double* out = y + pattern.work_start[j] + c;
  if constexpr (columns == 1) {
    out[0] = sum(t[0]);
  } else {
    store_first<columns>(out, rows - c, sums(t));
  }
  return columns;
}

/// y ← L_jj⁻¹ y for column j, and what the rows i below, at of_row(i), lose by it.
template <typename Number>
template <int equal, typename OfRow>
void BlockFactor<Number>::eliminate(const BlockPattern& pattern, std::size_t j, double* y,
                                    const OfRow& of_row) {
  const int size = size_of<equal>(pattern, j), rows = stride_of<equal>(pattern, j);
  multiply(rows / row_padding, size, &values_[pattern.column_value[j]], y, solved_.data());
  for (int l = 0; l < rows; l += row_padding) store(y + l, load(&solved_[at(l)]));
  for (std::size_t e = pattern.row_start[j]; e < pattern.row_start[j + 1]; ++e) {
    const std::size_t i = pattern.rows[e];
    subtract_times(stride_of<equal>(pattern, i) / row_padding, size, &values_[pattern.row_value[e]], y,
                   of_row(i));
  }
}

template <typename Number>
void BlockFactor<Number>::forward(const BlockPattern& pattern, std::span<double> y) {
  const auto of_row = [&](std::size_t i) { return &y[pattern.work_start[i]]; };
  for_equal_size(pattern, [&]<int equal>() {
    for (std::size_t j = 0; j < pattern.columns(); ++j) {
      double* y_j = of_row(j);
      // Zero, as where a step has settled.
      if (std::all_of(y_j, y_j + size_of<equal>(pattern, j), [](double v) { return v == 0.0; })) continue;
      eliminate<equal>(pattern, j, y_j, of_row);
    }
  });
}

template <typename Number>
void BlockFactor<Number>::backward(const BlockPattern& pattern, std::span<double> y) {
  std::fill(solved_.begin(), solved_.end(), 0.0);
  for_equal_size(pattern, [&]<int equal>() {
    for (std::size_t j = pattern.columns(); j-- > 0;) {
      const int size = size_of<equal>(pattern, j);
      for (int c = 0; c < size;)
        c += size - c >= 6 ? gather<equal, 6>(pattern, j, c, y.data())
                           : gather<equal, 1>(pattern, j, c, y.data());
      for (int c = 0; c < size;)
        c += size - c >= 6 ? divide<equal, 6>(pattern, j, c, y.data())
                           : divide<equal, 1>(pattern, j, c, y.data());
    }
  });
}

/// The same of two vectors on their paths, which share what is read of L.
template <typename Number>
template <int equal>
void BlockFactor<Number>::eliminate_two(const BlockPattern& pattern, std::size_t j, ForwardVector& v,
                                        ForwardVector& w) {
  const auto of_row = [&](ForwardVector& x) {
    return [&](std::size_t i) { return &x.values[pattern.above[i]]; };
  };
  if constexpr (equal != 6) {
    eliminate<equal>(pattern, j, of_row(v)(j), of_row(v));
    eliminate<equal>(pattern, j, of_row(w)(j), of_row(w));
  } else {
    double *v_j = of_row(v)(j), *w_j = of_row(w)(j);
    for (double* y : {v_j, w_j}) {
      multiply(1, equal, &values_[pattern.column_value[j]], y, solved_.data());
      store(y, load(solved_.data()));
    }
    const TwoFactors<equal> factors(v_j, w_j);
    for (std::size_t e = pattern.row_start[j]; e < pattern.row_start[j + 1]; ++e) {
      const std::size_t above = pattern.above[pattern.rows[e]];
      factors.subtract_product(&values_[pattern.row_value[e]], &v.values[above], &w.values[above]);
    }
  }
}

/// The same of those vectors that are at column j of their paths; these go on to the next one.
template <typename Number>
template <int equal>
void BlockFactor<Number>::eliminate_on_paths(const BlockPattern& pattern, std::size_t j,
                                             std::span<ForwardVector> ws) {
  ForwardVector* waiting = nullptr;
  for (std::size_t k = 0; k < ws.size(); ++k) {
    if (at_[k] != j) continue;
    at_[k] = pattern.parent[j];
    if (waiting == nullptr) {
      waiting = &ws[k];
    } else {
      eliminate_two<equal>(pattern, j, *std::exchange(waiting, nullptr), ws[k]);
    }
  }
  if (waiting == nullptr) return;
  const auto of_row = [&](std::size_t i) { return &waiting->values[pattern.above[i]]; };
  eliminate<equal>(pattern, j, of_row(j), of_row);
}

template <typename Number>
void BlockFactor<Number>::forward(const BlockPattern& pattern, std::span<ForwardVector> ws) {
  at_.clear();
  for (const ForwardVector& w : ws) at_.push_back(at(w.column));
  for_equal_size(pattern, [&]<int equal>() {
    for (;;) {
      const std::size_t first = *std::min_element(at_.begin(), at_.end());
      if (first == BlockPattern::none) break;
      eliminate_on_paths<equal>(pattern, first, ws);
    }
  });
}

template class BlockFactor<float>;
template class BlockFactor<double>;

}  // namespace keyblock::linalg
