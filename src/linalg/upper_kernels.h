#pragma once
#include <cstddef>
#include <type_traits>

#include "linalg/block_kernels.h"
#include "linalg/paired_columns.h"
#include "linalg/scaled_matrix.h"
#include "linalg/solved_part.h"

/// Products of the columns and rows of a ScaledMatrix with padded vectors. `layout` says where blocks are in vectors: at run time, or known
/// to the compiler.
namespace keyblock::linalg {

/// Sizes of blocks and where they are in padded vectors.
struct AnyBlocks {
  const int *sizes, *strides;
  const std::size_t* starts;
  [[nodiscard]] int size(std::size_t j) const { return sizes[j]; }
  [[nodiscard]] int stride(std::size_t j) const { return strides[j]; }
  [[nodiscard]] std::size_t start(std::size_t j) const { return starts[j]; }
};

/// The same where all blocks are of order 1: known to the compiler.
struct BlocksOfOrder1 {
  static constexpr int size(std::size_t /*j*/) { return 6; }
  static constexpr int stride(std::size_t /*j*/) { return padded_rows(6); }
  static constexpr std::size_t start(std::size_t j) { return j * padded_rows(6); }
};

template <typename Body>
decltype(auto) with_layout(const BlockOrder& order, const Body& body) {
  if (order.all_of_six) return body(BlocksOfOrder1{});
  return body(AnyBlocks{order.size.data(), order.stride.data(), order.start.data()});
}

/// Calls body(k) for each register of block j.
template <typename Layout, typename Body>
void for_registers(Layout layout, std::size_t j, const Body& body) {
  for (int l = 0; l < layout.stride(j); l += row_padding) body(layout.start(j) + at(l));
}

/// y −= S_j x_j of the rows of the same part, with S_j what stands above the diagonal in column j, from `block` on.
template <typename Layout, typename Number>
void subtract_above(const UpperPattern& pattern, Layout layout, std::size_t j, const Number* block,
                    const Number* x, Number* y) {
  const Number* x_j = x + layout.start(j);
  for (std::size_t e = pattern.column_start[j]; e < pattern.own_start[j]; ++e)
    block += layout.stride(pattern.row[e]) * layout.size(j);
  for (std::size_t e = pattern.own_start[j]; e < pattern.column_start[j + 1]; ++e) {
    const std::size_t i = pattern.row[e];
    subtract_times(layout.stride(i) / row_padding, layout.size(j), block, x_j, y + layout.start(i));
    block += layout.stride(i) * layout.size(j);
  }
}

/// The same with U.
template <typename Layout>
void subtract_scaled(const ScaledMatrix& matrix, Layout layout, std::size_t j, const float* x, float* y) {
  const UpperPattern& pattern = matrix.pattern();
  if constexpr (std::is_same_v<Layout, BlocksOfOrder1>) {
    const float* block = matrix.above() + std::size_t{pattern.own_start[j]} * paired_columns::block_size;
    const paired_columns::Factors factors(load(x + layout.start(j)));
    for (std::size_t e = pattern.own_start[j]; e < pattern.column_start[j + 1];
         ++e, block += paired_columns::block_size) {
      float* y_i = y + layout.start(pattern.row[e]);
      store(y_i, load(y_i) - factors.product(block));
    }
  } else {
    subtract_above(pattern, layout, j, matrix.above() + pattern.above_start[j], x, y);
  }
}

/// Calls subtract(entry, row) for the entries of a row between the parts whose columns are solved: y −= S x of that row.
template <typename Subtract>
void for_entries(const ScaledMatrix& matrix, const SolvedPart& part, std::size_t row,
                 const Subtract& subtract) {
  const UpperPattern& pattern = matrix.pattern();
  for (std::size_t k = pattern.row_start[row]; k < pattern.row_start[row + 1]; ++k) {
    const UpperPattern::RowEntry& entry = pattern.row_entries[k];
    if (part.has(entry.column)) subtract(entry, row);
  }
}

/// The same for all rows between the parts. Rows gather, so that no two parts write to them.
template <typename Subtract>
void for_entries_between(const ScaledMatrix& matrix, const SolvedPart& part, const Subtract& subtract) {
  part.for_rows_between([&](std::size_t row) { for_entries(matrix, part, row, subtract); });
}

/// y −= U x of the rows between the parts, of columns in parts.
template <typename Layout>
void subtract_scaled_of_parts(const ScaledMatrix& matrix, const SolvedPart& part, Layout layout,
                              const float* x, float* y) {
  for_entries_between(matrix, part, [&](const UpperPattern::RowEntry& entry, std::size_t row) {
    const float *block = matrix.above_by_rows() + entry.copy, *x_j = x + layout.start(entry.column);
    float* y_i = y + layout.start(row);
    if constexpr (std::is_same_v<Layout, BlocksOfOrder1>) {
      store(y_i, load(y_i) - paired_columns::Factors(load(x_j)).product(block));
    } else {
      subtract_times(layout.stride(row) / row_padding, layout.size(entry.column), block, x_j, y_i);
    }
  });
}

/// y_j ← (Uᵀ x)_j.
template <typename Layout>
void store_transposed(const ScaledMatrix& matrix, Layout layout, std::size_t j, const float* x, float* y) {
  const UpperPattern& pattern = matrix.pattern();
  if constexpr (std::is_same_v<Layout, BlocksOfOrder1>) {
    const float* block = matrix.above() + std::size_t{pattern.column_start[j]} * paired_columns::block_size;
    paired_columns::RowProducts products;
    for (std::size_t e = pattern.column_start[j]; e < pattern.column_start[j + 1];
         ++e, block += paired_columns::block_size)
      products.add(block, paired_columns::Rows(load(x + layout.start(pattern.row[e]))));
    store(y + layout.start(j), products.sums());
  } else {
    in_sixes(layout.size(j), [&]<int width>(int c) {
      NarrowLanes t[width]{};
      const float* values = matrix.above() + pattern.above_start[j];
      for (std::size_t e = pattern.column_start[j]; e < pattern.column_start[j + 1]; ++e) {
        const std::size_t i = pattern.row[e];
        add_lane_products(layout.stride(i) / row_padding, values + c * layout.stride(i), x + layout.start(i),
                          t);
        values += layout.stride(i) * layout.size(j);
      }
      store_first<width>(y + layout.start(j) + at(c), layout.stride(j) - c, sums(t));
    });
  }
}

/// x_j ← C_j⁻ᵀ v_j; scratch: a padded vector.
template <typename Layout>
void unscale(const ScaledMatrix& matrix, Layout layout, std::size_t j, const float* v, double* scratch,
             double* x) {
  for_registers(layout, j, [&](std::size_t k) { store(scratch + k, widen(load(v + k))); });
  const double *wide = scratch + layout.start(j), *inverse = matrix.inverse(j);
  const int stride = layout.stride(j);
  in_sixes(layout.size(j), [&]<int width>(int c) {
    Lanes t[width]{};
    add_lane_products(stride / row_padding, inverse + c * stride, wide, t);
    store_first<width>(x + layout.start(j) + c, stride - c, sums(t));
  });
}

/// y −= A x of column j and row j of A, except for rows of other parts.
template <typename Layout>
void subtract_product_of(const ScaledMatrix& matrix, Layout layout, std::size_t j, const double* x,
                         double* y) {
  const UpperPattern& pattern = matrix.pattern();
  const double *x_j = x + layout.start(j), *block = matrix.column(j);
  double* y_j = y + layout.start(j);
  const int size = layout.size(j), stride = layout.stride(j);
  subtract_times(stride / row_padding, size, block, x_j, y_j);
  block += stride * size;
  subtract_above(pattern, layout, j, block, x, y);
  for (std::size_t e = pattern.column_start[j]; e < pattern.column_start[j + 1]; ++e) {
    const std::size_t i = pattern.row[e];
    subtract_transposed(block, layout.stride(i), size, x + layout.start(i), stride, y_j);
    block += layout.stride(i) * size;
  }
}

/// The same at the edge of a neighbourhood, of row j above the diagonal.
template <typename Layout>
void subtract_product_at_edge(const ScaledMatrix& matrix, const SolvedPart& part, Layout layout,
                              std::size_t j, const double* x, double* y) {
  const UpperPattern& pattern = matrix.pattern();
  const int size = layout.size(j), stride = layout.stride(j);
  const double* block = matrix.column(j) + static_cast<std::ptrdiff_t>(stride) * size;
  for (std::size_t e = pattern.column_start[j]; e < pattern.column_start[j + 1]; ++e) {
    const std::size_t i = pattern.row[e];
    if (part.has(i))
      subtract_transposed(block, layout.stride(i), size, x + layout.start(i), stride, y + layout.start(j));
    block += layout.stride(i) * size;
  }
}

}  // namespace keyblock::linalg
