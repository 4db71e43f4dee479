// The matrix of conjugate residuals, and what is scaled by its diagonal blocks.
#include <algorithm>

#include "linalg/block_conjugate_residual.h"
#include "linalg/block_kernels.h"
#include "linalg/paired_columns.h"

namespace keyblock::linalg {

void BlockConjugateResidual::clear() {
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  all_stale_ = true;
  // Each diagonal block is followed by those above it, and these by the next diagonal block.
  const auto start = [&](std::size_t place) {
    return matrix_.data() + (place < diagonal_.size() ? diagonal_[place] : matrix_.size());
  };
  for_ranges([&](std::size_t, Range range) { std::fill(start(range.first), start(range.last), 0.0); });
}

/// C_i⁻¹ A C_j⁻ᵀ
void BlockConjugateResidual::scale_block(std::size_t i, std::size_t j, const double* a,
                                         double* scaled) const {
  const double *left = &inverse_[inverse_start_[i]], *right = &inverse_[inverse_start_[j]];
  const auto multiply_left = [&](int lanes, int rows, int columns) {
    for (int c = 0; c < columns; ++c) {
      const int first = c * lanes * row_padding;
      multiply(lanes, rows, left, a + first, scaled + first);
    }
  };
  if (size_[i] == 6 && size_[j] == 6) {
    multiply_left(1, 6, 6);
    multiply_right<6>(right, scaled);
  } else {
    multiply_left(stride_[i] / row_padding, size_[i], size_[j]);
    multiply_right(stride_[i] / row_padding, size_[j], right, scaled);
  }
}

/// In single precision, as U has it.
void BlockConjugateResidual::store_scaled(std::size_t i, std::size_t j, const double* scaled,
                                          float* above) const {
  if (!same_) {
    for (int k = 0; k < stride_[i] * size_[j]; k += row_padding) store(above + k, narrow(load(scaled + k)));
    return;
  }
  for (int c = 0; c < paired_columns::rows; ++c) {
    const NarrowLanes column = narrow(load(scaled + c * row_padding));
    for (int r = 0; r < paired_columns::rows; ++r) above[c * paired_columns::rows + r] = column[r];
  }
}

/// C_j and its inverse. False where the block is not positive definite.
bool BlockConjugateResidual::scale_diagonal(std::size_t j, WideVector& scratch) {
  double* diagonal = &matrix_[diagonal_[j]];
  for (int c = 1; c < size_[j]; ++c) {
    for (int r = 0; r < c; ++r) diagonal[c * stride_[j] + r] = diagonal[r * stride_[j] + c];
  }
  const std::size_t count = at(stride_[j] * size_[j]);
  double* inverse = &inverse_[inverse_start_[j]];
  std::copy_n(diagonal, count, inverse);
  if (!(size_[j] == 6 ? invert_factor<6>(inverse) : invert_factor(size_[j], inverse, scratch.data())))
    return false;
  // C = A C⁻ᵀ
  std::copy_n(diagonal, count, scratch.data());
  if (size_[j] == 6) {
    multiply_right<6>(inverse, scratch.data());
  } else {
    multiply_right(stride_[j] / row_padding, size_[j], inverse, scratch.data());
  }
  for (std::size_t i = 0; i < count; i += row_padding)
    store(&scale_[inverse_start_[j] + i], narrow(load(&scratch[i])));
  return true;
}

/// What is above the diagonal in a column, where one of its two blocks is stale.
void BlockConjugateResidual::scale_above(std::size_t j, WideVector& scratch) {
  const double* values = &matrix_[diagonal_[j]] + at(stride_[j] * size_[j]);
  float* above = above_.data() + above_start_[j];
  for (std::size_t e = column_start_[j]; e < column_start_[j + 1]; ++e) {
    const std::size_t i = rows_[e];
    if (stale_[i] != 0 || stale_[j] != 0) {
      scale_block(i, j, values, scratch.data());
      store_scaled(i, j, scratch.data(), above);
    }
    values += stride_[i] * size_[j];
    above += scaled_count(i, j);
  }
}

/// Of a row between the parts, what was scaled anew.
void BlockConjugateResidual::copy_row_between(std::size_t row) {
  for (std::size_t k = row_start_[row]; k < row_start_[row + 1]; ++k) {
    const RowEntry& entry = row_entries_[k];
    if (stale_[row] != 0 || stale_[entry.column] != 0)
      std::copy_n(&above_[entry.above], scaled_count(row, entry.column), &above_by_rows_[entry.copy]);
  }
}

bool BlockConjugateResidual::factor_all() {
  std::vector<std::uint8_t> good(begin_.size() - 1, 1);
  for_ranges([&](std::size_t k, Range range) {
    WideVector scratch(at(largest_ * largest_));
    for (std::size_t j = range.first; j < range.last && good[k] != 0; ++j) {
      if (stale_[j] != 0) good[k] = scale_diagonal(j, scratch);
    }
  });
  if (std::find(good.begin(), good.end(), 0) != good.end()) return false;
  for_ranges([&](std::size_t, Range range) {
    WideVector scratch(at(largest_ * largest_));
    for (std::size_t j = range.first; j < range.last; ++j) scale_above(j, scratch);
  });
  for_rows_between([&](std::size_t row) { copy_row_between(row); });
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{0});
  return true;
}

/// Likewise, where few blocks are stale.
bool BlockConjugateResidual::factor_touched() {
  WideVector scratch(at(largest_ * largest_));
  touched_.clear();
  for (const std::uint32_t j : stale_places_) {
    if (!scale_diagonal(j, scratch)) return false;
    touched_.push_back(j);
    touched_.insert(touched_.end(), neighbours(j).begin(), neighbours(j).end());
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const std::uint32_t j : touched_) scale_above(j, scratch);
  for (const std::uint32_t j : touched_) {
    if (j < between().last) copy_row_between(j);
  }
  for (const std::uint32_t j : stale_places_) stale_[j] = 0;
  return true;
}

bool BlockConjugateResidual::factor() {
  constexpr std::size_t few = 8;  // of which all blocks are as many times as many
  lag_ = lag_near_ = {};
  if (!(all_stale_ || few * stale_places_.size() > place_.size() ? factor_all() : factor_touched()))
    return false;
  all_stale_ = false;
  stale_places_.clear();
  return true;
}

}  // namespace keyblock::linalg
