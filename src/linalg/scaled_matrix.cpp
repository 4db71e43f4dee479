#include "linalg/scaled_matrix.h"

#include <algorithm>

#include "core/assign_with_room.h"
#include "linalg/block_kernels.h"
#include "linalg/numbers.h"
#include "linalg/paired_columns.h"
#include "linalg/solved_part.h"

namespace keyblock::linalg {

void ScaledMatrix::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  order_.analyse(sizes, pairs);
  pattern_.analyse(order_, pairs);
  assign_with_room(values_, pattern_.values, 0.0);
  assign_with_room(inverse_, pattern_.inverses, 0.0);
  assign_with_room(scale_, pattern_.inverses, 0.0F);
  assign_with_room(above_, pattern_.scaled + paired_columns::read_beyond, 0.0F);
  assign_with_room(above_by_rows_, pattern_.copied + paired_columns::read_beyond, 0.0F);
  stale_.assign(order_.blocks(), 1);
  all_stale_ = true;
  stale_positions_.clear();
  slots_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const bool i_above = order_.position[at(i)] < order_.position[at(j)];
    slots_.push_back({&values_[pattern_.pair_value[k]], padded_rows(sizes[at(i_above ? i : j)]),
                      i_above ? i : j, i_above ? j : i});
  }
}

void ScaledMatrix::clear(ThreadTeam* team) {
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  all_stale_ = true;
  // Each diagonal block is followed by those above it, and these by the next diagonal block.
  const auto start = [&](std::size_t j) {
    return values_.data() + (j < order_.blocks() ? pattern_.diagonal[j] : values_.size());
  };
  SolvedPart(order_, nullptr, team).for_pieces([&](std::size_t, auto positions) {
    for_each_position(positions, [&](std::size_t j) { std::fill(start(j), start(j + 1), 0.0); });
  });
}

/// C_i⁻¹ A C_j⁻ᵀ
void ScaledMatrix::scale_block(std::size_t i, std::size_t j, const double* a, double* scaled) const {
  const double *left = inverse(i), *right = inverse(j);
  const int rows = order_.size[i], columns = order_.size[j], registers = order_.stride[i] / row_padding;
  const auto multiply_left = [&](int lanes, int size, int count) {
    for (int c = 0; c < count; ++c) {
      const int first = c * lanes * row_padding;
      multiply(lanes, size, left, a + first, scaled + first);
    }
  };
  if (rows == 6 && columns == 6) {
    multiply_left(1, 6, 6);
    multiply_right<6>(right, scaled);
  } else {
    multiply_left(registers, rows, columns);
    multiply_right(registers, columns, right, scaled);
  }
}

/// In single precision, as U has it.
void ScaledMatrix::store_scaled(std::size_t i, std::size_t j, const double* scaled, float* above) const {
  if (!order_.all_of_six) {
    for (int k = 0; k < order_.stride[i] * order_.size[j]; k += row_padding)
      store(above + k, narrow(load(scaled + k)));
    return;
  }
  for (int c = 0; c < paired_columns::rows; ++c) {
    const NarrowLanes column = narrow(load(scaled + c * row_padding));
    for (int r = 0; r < paired_columns::rows; ++r) above[c * paired_columns::rows + r] = column[r];
  }
}

/// C_j and its inverse. False where the block is not positive definite.
bool ScaledMatrix::scale_diagonal(std::size_t j, WideVector& scratch) {
  const int size = order_.size[j], stride = order_.stride[j];
  double* diagonal = &values_[pattern_.diagonal[j]];
  for (int c = 1; c < size; ++c) {
    for (int r = 0; r < c; ++r) diagonal[c * stride + r] = diagonal[r * stride + c];
  }
  const std::size_t count = at(stride * size);
  double* inverse = &inverse_[pattern_.inverse_start[j]];
  std::copy_n(diagonal, count, inverse);
  if (!(size == 6 ? invert_factor<6>(inverse) : invert_factor(size, inverse, scratch.data()))) return false;
  // C = A C⁻ᵀ
  std::copy_n(diagonal, count, scratch.data());
  if (size == 6) {
    multiply_right<6>(inverse, scratch.data());
  } else {
    multiply_right(stride / row_padding, size, inverse, scratch.data());
  }
  for (std::size_t i = 0; i < count; i += row_padding)
    store(&scale_[pattern_.inverse_start[j] + i], narrow(load(&scratch[i])));
  return true;
}

/// What is above the diagonal in a column, where one of its two blocks is stale.
void ScaledMatrix::scale_above(std::size_t j, WideVector& scratch) {
  const double* values = column(j) + at(order_.stride[j] * order_.size[j]);
  float* above = above_.data() + pattern_.above_start[j];
  for (std::size_t e = pattern_.column_start[j]; e < pattern_.column_start[j + 1]; ++e) {
    const std::size_t i = pattern_.row[e];
    if (stale_[i] != 0 || stale_[j] != 0) {
      scale_block(i, j, values, scratch.data());
      store_scaled(i, j, scratch.data(), above);
    }
    values += order_.stride[i] * order_.size[j];
    above += UpperPattern::scaled_count(order_, i, j);
  }
}

/// Of a row between the parts, what was scaled again.
void ScaledMatrix::copy_row_between(std::size_t row) {
  for (std::size_t k = pattern_.row_start[row]; k < pattern_.row_start[row + 1]; ++k) {
    const UpperPattern::RowEntry& entry = pattern_.row_entries[k];
    if (stale_[row] != 0 || stale_[entry.column] != 0)
      std::copy_n(&above_[entry.above], UpperPattern::scaled_count(order_, row, entry.column),
                  &above_by_rows_[entry.copy]);
  }
}

bool ScaledMatrix::factor_all(ThreadTeam* team) {
  const SolvedPart all(order_, nullptr, team);
  const auto scratch_size = at(order_.largest * order_.largest);
  std::vector<std::uint8_t> good(all.pieces(), 1);
  all.for_pieces([&](std::size_t k, auto positions) {
    WideVector scratch(scratch_size);
    for_each_position(positions, [&](std::size_t j) {
      if (good[k] != 0 && stale_[j] != 0) good[k] = scale_diagonal(j, scratch);
    });
  });
  if (std::find(good.begin(), good.end(), 0) != good.end()) return false;
  all.for_pieces([&](std::size_t, auto positions) {
    WideVector scratch(scratch_size);
    for_each_position(positions, [&](std::size_t j) { scale_above(j, scratch); });
  });
  all.for_rows_between([&](std::size_t row) { copy_row_between(row); });
  std::fill(stale_.begin(), stale_.end(), std::uint8_t{0});
  return true;
}

/// The same, where few blocks are stale.
bool ScaledMatrix::factor_touched() {
  WideVector scratch(at(order_.largest * order_.largest));
  touched_.clear();
  for (const std::uint32_t j : stale_positions_) {
    if (!scale_diagonal(j, scratch)) return false;
    touched_.push_back(j);
    const std::span<const std::uint32_t> neighbours = pattern_.neighbours(j);
    touched_.insert(touched_.end(), neighbours.begin(), neighbours.end());
  }
  std::sort(touched_.begin(), touched_.end());
  touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
  for (const std::uint32_t j : touched_) scale_above(j, scratch);
  for (const std::uint32_t j : touched_) {
    if (j < order_.between()) copy_row_between(j);
  }
  for (const std::uint32_t j : stale_positions_) stale_[j] = 0;
  return true;
}

bool ScaledMatrix::factor(ThreadTeam* team) {
  const bool few = !all_stale_ && numbers::few_changed * stale_positions_.size() <= order_.blocks();
  if (!(few ? factor_touched() : factor_all(team))) return false;
  all_stale_ = false;
  stale_positions_.clear();
  return true;
}

}  // namespace keyblock::linalg
