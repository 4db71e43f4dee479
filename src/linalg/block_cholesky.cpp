#include "linalg/block_cholesky.h"

#include <algorithm>

#include "linalg/block_kernels.h"

namespace keyblock::linalg {

void BlockCholesky::load_column(std::size_t j) {
  const std::size_t end = j + 1 < size_.size() ? column_value_[j + 1] : values_.size();
  std::size_t filled = column_value_[j];
  const auto clear_up_to = [&](std::size_t place) {
    for (; filled < place; filled += row_padding) store(&values_[filled], Lanes{});
  };
  for (std::size_t k = source_start_[j]; k < source_start_[j + 1]; ++k) {
    const Source& source = sources_[k];
    clear_up_to(source.to);
    for (std::size_t v = 0; v < source.count; v += row_padding)
      store(&values_[source.to + v], load(&matrix_[source.from + v]));
    filled += source.count;
  }
  clear_up_to(end);
}

/// A_ij −= Σ_k L_ik L_jkᵀ for all rows i of column j.
template <int equal>
void BlockCholesky::update_column(std::size_t j) {
  target_[j] = &values_[column_value_[j]];
  for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) target_[rows_[e]] = &values_[row_value_[e]];
  for (std::size_t u = update_start_[j]; u < update_start_[j + 1]; ++u) {
    const auto [k, first] = updates_[u];
    const double* l_jk = &values_[row_value_[first]];
    for (std::size_t e = first; e < row_start_[k + 1]; ++e) {
      const std::size_t i = rows_[e];
      if constexpr (equal > 0) {
        subtract_block_product<equal>(&values_[row_value_[e]], l_jk, target_[i]);
      } else {
        subtract_block_product(stride_[i] / row_padding, size_[j], size_[k], &values_[row_value_[e]], l_jk,
                               stride_[j], target_[i]);
      }
    }
  }
}

template <int equal>
bool BlockCholesky::factor_columns() {
  for (std::size_t j = 0; j < size_.size(); ++j) {
    if (stale_[j] == 0) continue;
    // What is eliminated later depends on this column through its parent in the elimination tree.
    if (parent_[j] != none) stale_[parent_[j]] = 1;
    load_column(j);
    update_column<equal>(j);
    double* inverse = &values_[column_value_[j]];
    if constexpr (equal > 0) {
      if (!invert_factor<equal>(inverse)) return false;
    } else {
      if (!invert_factor(size<equal>(j), inverse, scale_.data())) return false;
    }
    for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
      double* x = &values_[row_value_[e]];
      if constexpr (equal > 0) {
        multiply_right<equal>(inverse, x);
      } else {
        multiply_right(stride<equal>(rows_[e]) / row_padding, size<equal>(j), inverse, x);
      }
    }
    stale_[j] = 0;
  }
  return true;
}

/// Calls what.template operator()<equal>().
template <typename Do>
void BlockCholesky::for_equal_size(const Do& what) const {
  if (equal_size_ == 6) {
    what.template operator()<6>();
  } else if (equal_size_ == 12) {
    what.template operator()<12>();
  } else {
    what.template operator()<0>();
  }
}

bool BlockCholesky::factor() {
  bool positive = false;
  for_equal_size([&]<int equal>() { positive = factor_columns<equal>(); });
  return positive;
}

/// y − Σ_i L_ijᵀ x_i for some unknowns of column j, from c on, into solved_. Returns their number.
template <int equal, int columns>
int BlockCholesky::gather(std::size_t j, int c) {
  Lanes t[columns]{};
  for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    const int rows = stride<equal>(i);
    add_lane_products(rows / row_padding, &values_[row_value_[e] + at(c * rows)], &work_[work_start_[i]], t);
  }
  const double* y = &work_[work_start_[j] + at(c)];
  double* out = &solved_[at(c)];
  if constexpr (columns == 1) {
    out[0] = y[0] - sum(t[0]);
  } else {
    store_first<columns>(out, stride<equal>(j) - c, load(y) - sums(t));
  }
  return columns;
}

/// L_jj⁻ᵀ y likewise.
template <int equal, int columns>
int BlockCholesky::divide(std::size_t j, int c) {
  Lanes t[columns]{};
  const int rows = stride<equal>(j);
  add_lane_products(rows / row_padding, &values_[column_value_[j] + at(c * rows)], solved_.data(), t);
  double* out = &work_[work_start_[j] + at(c)];
  if constexpr (columns == 1) {
    out[0] = sum(t[0]);
  } else {
    store_first<columns>(out, stride<equal>(j) - c, sums(t));
  }
  return columns;
}

/// Brings x into the order of elimination.
void BlockCholesky::take(std::span<const double> x) {
  for_equal_size([&]<int equal>() {
    for (std::size_t j = 0; j < size_.size(); ++j)
      std::copy_n(&x[offset_[j]], size<equal>(j), &work_[work_start_[j]]);
  });
}

void BlockCholesky::give(std::span<double> x) const {
  for_equal_size([&]<int equal>() {
    for (std::size_t j = 0; j < size_.size(); ++j)
      std::copy_n(&work_[work_start_[j]], size<equal>(j), &x[offset_[j]]);
  });
}

/// y ← L_jj⁻¹ y for column j, and what the rows i below, at of_row(i), lose by it.
template <int equal, typename OfRow>
void BlockCholesky::eliminate(std::size_t j, double* y, const OfRow& of_row) {
  const int size_j = size<equal>(j), rows = stride<equal>(j);
  multiply(rows / row_padding, size_j, &values_[column_value_[j]], y, solved_.data());
  for (int l = 0; l < rows; l += row_padding) store(y + l, load(&solved_[at(l)]));
  for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    subtract_times(stride<equal>(i) / row_padding, size_j, &values_[row_value_[e]], y, of_row(i));
  }
}

template <int equal>
void BlockCholesky::forward() {
  const auto of_row = [&](std::size_t i) { return &work_[work_start_[i]]; };
  for (std::size_t j = 0; j < size_.size(); ++j) {
    double* y = of_row(j);
    // Zero, as where a step has settled.
    if (std::all_of(y, y + size<equal>(j), [](double v) { return v == 0.0; })) continue;
    eliminate<equal>(j, y, of_row);
  }
}

template <int equal>
void BlockCholesky::backward() {
  std::fill(solved_.begin(), solved_.end(), 0.0);
  for (std::size_t j = size_.size(); j-- > 0;) {
    const int size_j = size<equal>(j);
    for (int c = 0; c < size_j;) c += size_j - c >= 6 ? gather<equal, 6>(j, c) : gather<equal, 1>(j, c);
    for (int c = 0; c < size_j;) c += size_j - c >= 6 ? divide<equal, 6>(j, c) : divide<equal, 1>(j, c);
  }
}

void BlockCholesky::solve(std::span<double> x, std::span<double> residual, const Excess& /*excess*/,
                          Residual /*kind*/) {
  std::fill(residual.begin(), residual.end(), 0.0);
  take(x);
  for_equal_size([&]<int equal>() {
    forward<equal>();
    backward<equal>();
  });
  give(x);
}

template <int equal>
void BlockCholesky::half_forward(HalfSolution& half) {
  const auto of_row = [&](std::size_t i) { return &half.values[above_[i]]; };
  for (std::size_t j = at(half.column); j != none; j = parent_[j]) eliminate<equal>(j, of_row(j), of_row);
}

void BlockCholesky::half_solve(Part a, Part b, HalfSolution& half) {
  std::size_t first = none;
  for (const Part& part : {a, b}) {
    if (part.block >= 0) first = std::min(first, position_[at(part.block)]);
  }
  half.column = static_cast<int>(first);
  half.values.assign(above_[first] + at(stride_[first]), 0.0);
  for (const Part& part : {a, b}) {
    if (part.block >= 0)
      std::copy(part.values.begin(), part.values.end(), &half.values[above_[position_[at(part.block)]]]);
  }
  for_equal_size([&]<int equal>() { half_forward<equal>(half); });
}

double BlockCholesky::product(const HalfSolution& x, const HalfSolution& y) const {
  // The ways have all in common from where they meet.
  std::size_t i = at(x.column), j = at(y.column);
  while (i != j && i != none && j != none) (i < j ? i : j) = parent_[std::min(i, j)];
  if (i != j || i == none) return 0.0;
  Lanes t{};
  for (std::size_t k = 0; k < above_[i] + at(stride_[i]); k += row_padding)
    t = add_product(load(&x.values[k]), load(&y.values[k]), t);
  return sum(t);
}

double BlockCholesky::product(const HalfSolution& x, std::span<const double> y) const {
  Lanes t{};
  for (std::size_t j = at(x.column); j != none; j = parent_[j]) {
    for (std::size_t l = 0; l < at(stride_[j]); l += row_padding)
      t = add_product(load(&x.values[above_[j] + l]), load(&y[work_start_[j] + l]), t);
  }
  return sum(t);
}

void BlockCholesky::half_solve(std::span<const double> b, std::vector<double>& half) {
  take(b);
  for_equal_size([&]<int equal>() { forward<equal>(); });
  half = work_;
}

void BlockCholesky::finish(std::span<const double> half, std::span<const HalfSolution> halves,
                           std::span<const double> factor, std::span<double> x) {
  std::copy(half.begin(), half.end(), work_.begin());
  for (std::size_t k = 0; k < halves.size(); ++k) {
    for (std::size_t j = at(halves[k].column); j != none; j = parent_[j]) {
      double* y = &work_[work_start_[j]];
      for (int l = 0; l < stride_[j]; l += row_padding)
        store(y + l,
              add_product(broadcast(factor[k]), load(&halves[k].values[above_[j] + at(l)]), load(y + l)));
    }
  }
  for_equal_size([&]<int equal>() { backward<equal>(); });
  give(x);
}

std::unique_ptr<BlockSolver> make_block_cholesky() {
  return std::make_unique<BlockCholesky>();
}

}  // namespace keyblock::linalg
