// Where the blocks of a matrix, and what belongs to them in vectors, are.
#include <algorithm>
#include <numeric>

#include "core/assign_with_room.h"
#include "linalg/block_conjugate_residual.h"
#include "linalg/paired_columns.h"
#include "linalg/partition.h"

namespace keyblock::linalg {

void BlockConjugateResidual::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  Partition found = partition(sizes.size(), pairs);
  begin_ = std::move(found.begin);
  dots_.assign(begin_.size() - 1, {});
  place_.resize(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) place_[at(found.order[k])] = k;
  block_at_ = found.order;
  find_neighbours(pairs);
  place_vectors(sizes, found.order);
  const std::vector<std::size_t> values = place_matrix(pairs);
  slots_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const bool i_above = place_[at(i)] < place_[at(j)];
    slots_.push_back(
        {&matrix_[values[k]], padded_rows(sizes[at(i_above ? i : j)]), i_above ? i : j, i_above ? j : i});
  }
}

void BlockConjugateResidual::place_vectors(std::span<const int> sizes, std::span<const int> order) {
  std::vector<std::size_t> unknown(sizes.size() + 1, 0);
  for (std::size_t b = 0; b < sizes.size(); ++b) unknown[b + 1] = unknown[b] + at(sizes[b]);
  size_.clear();
  stride_.clear();
  offset_.clear();
  start_.clear();
  largest_ = 0;
  same_ = std::ranges::all_of(sizes, [](int size) { return size == 6; });
  std::size_t padded = 0;
  for (const int block : order) {
    const int size = sizes[at(block)];
    size_.push_back(size);
    stride_.push_back(padded_rows(size));
    offset_.push_back(unknown[at(block)]);
    start_.push_back(padded);
    padded += at(padded_rows(size));
    largest_ = std::max(largest_, padded_rows(size));
  }
  for (Vector* v : {&t_, &z_, &r_, &p_, &q_, &s_}) assign_with_room(*v, padded, 0.0F);
  for (WideVector* v : {&wide_, &product_}) assign_with_room(*v, padded, 0.0);
}

void BlockConjugateResidual::find_neighbours(std::span<const std::pair<int, int>> pairs) {
  neighbours_start_.assign(place_.size() + 1, 0);
  for (const auto& [i, j] : pairs) {
    ++neighbours_start_[place_[at(i)] + 1];
    ++neighbours_start_[place_[at(j)] + 1];
  }
  std::partial_sum(neighbours_start_.begin(), neighbours_start_.end(), neighbours_start_.begin());
  neighbours_.resize(neighbours_start_.back());
  std::vector<std::size_t> next(neighbours_start_.begin(), neighbours_start_.end() - 1);
  for (const auto& [i, j] : pairs) {
    neighbours_[next[place_[at(i)]]++] = static_cast<std::uint32_t>(place_[at(j)]);
    neighbours_[next[place_[at(j)]]++] = static_cast<std::uint32_t>(place_[at(i)]);
  }
}

std::size_t BlockConjugateResidual::scaled_count(std::size_t i, std::size_t j) const {
  return same_ ? std::size_t{paired_columns::block_size} : at(stride_[i] * size_[j]);
}

/// Where the block of every pair is in matrix_.
std::vector<std::size_t> BlockConjugateResidual::place_matrix(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = size_.size();
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> above(n);  // row, pair
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [low, high] = std::minmax(place_[at(pairs[k].first)], place_[at(pairs[k].second)]);
    above[high].emplace_back(low, k);
  }
  diagonal_.clear();
  inverse_start_.clear();
  above_start_.clear();
  rows_.clear();
  column_start_.assign(1, 0);
  own_start_.clear();
  std::vector<std::size_t> values(pairs.size());
  std::vector<std::vector<RowEntry>> of_row(between().last);
  std::size_t used = 0, scaled = 0, inverse = 0;
  for (std::size_t j = 0; j < n; ++j) {
    diagonal_.push_back(used);
    inverse_start_.push_back(inverse);
    above_start_.push_back(scaled);
    used += at(stride_[j] * size_[j]);
    inverse += at(stride_[j] * size_[j]);
    std::sort(above[j].begin(), above[j].end());
    own_start_.push_back(static_cast<std::uint32_t>(rows_.size()));
    for (const auto& [row, k] : above[j]) {
      rows_.push_back(static_cast<std::uint32_t>(row));
      if (row < between().last && j >= between().last) {
        of_row[row].push_back({j, used, scaled, 0});
        own_start_[j] = static_cast<std::uint32_t>(rows_.size());
      }
      values[k] = used;
      used += at(stride_[row] * size_[j]);
      scaled += scaled_count(row, j);
    }
    column_start_.push_back(static_cast<std::uint32_t>(rows_.size()));
  }
  row_start_.assign(1, 0);
  row_entries_.clear();
  std::size_t copied = 0;
  for (std::size_t row = 0; row < of_row.size(); ++row) {
    for (RowEntry entry : of_row[row]) {
      entry.copy = copied;
      row_entries_.push_back(entry);
      copied += scaled_count(row, entry.column);
    }
    row_start_.push_back(row_entries_.size());
  }
  assign_with_room(matrix_, used, 0.0);
  assign_with_room(inverse_, inverse, 0.0);
  assign_with_room(scale_, inverse, 0.0F);
  assign_with_room(above_, scaled + paired_columns::read_beyond, 0.0F);
  assign_with_room(above_by_rows_, copied + paired_columns::read_beyond, 0.0F);
  stale_.assign(n, 1);
  all_stale_ = true;
  stale_places_.clear();
  return values;
}

}  // namespace keyblock::linalg
