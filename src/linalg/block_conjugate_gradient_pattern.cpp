// Where the blocks of a matrix, and what belongs to them in vectors, are.
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "linalg/block_conjugate_gradient.h"
#include "linalg/partition.h"

namespace keyblock::linalg {

void BlockConjugateGradient::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  Partition found = partition(sizes.size(), pairs);
  begin_ = std::move(found.begin);
  sums_.assign(begin_.size() - 1, 0.0);
  place_.resize(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) place_[at(found.order[k])] = k;
  place_vectors(sizes, found.order);
  const std::vector<std::size_t> values = place_matrix(pairs);
  slots_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const bool i_below = place_[at(i)] > place_[at(j)];
    slots_.push_back(
        {&matrix_[values[k]], padded_rows(sizes[at(i_below ? i : j)]), i_below ? i : j, i_below ? j : i});
  }
}

void BlockConjugateGradient::place_vectors(std::span<const int> sizes, std::span<const int> order) {
  std::vector<std::size_t> unknown(sizes.size() + 1, 0);
  for (std::size_t b = 0; b < sizes.size(); ++b) unknown[b + 1] = unknown[b] + at(sizes[b]);
  size_.clear();
  stride_.clear();
  offset_.clear();
  start_.clear();
  largest_ = 0;
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
  for (Vector* v : {&t_, &z_, &r_, &p_, &q_}) v->assign(padded, 0.0F);
  for (WideVector* v : {&wide_, &product_}) v->assign(padded, 0.0);
}

/// Where the block of every pair is in matrix_.
std::vector<std::size_t> BlockConjugateGradient::place_matrix(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = size_.size(), first_between = between().first;
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> below(n);  // row, pair
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [low, high] = std::minmax(place_[at(pairs[k].first)], place_[at(pairs[k].second)]);
    below[low].emplace_back(high, k);
  }
  diagonal_.clear();
  inverse_start_.clear();
  entries_.clear();
  entry_start_.assign(1, 0);
  between_start_.clear();
  std::vector<std::size_t> values(pairs.size());
  std::vector<std::vector<RowEntry>> rows(n - first_between);
  std::size_t used = 0, lower = 0, inverse = 0;
  for (std::size_t j = 0; j < n; ++j) {
    diagonal_.push_back(used);
    inverse_start_.push_back(inverse);
    used += at(stride_[j] * size_[j]);
    inverse += at(stride_[j] * size_[j]);
    std::sort(below[j].begin(), below[j].end());
    between_start_.push_back(entries_.size());
    for (const auto& [row, k] : below[j]) {
      entries_.push_back({static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(used),
                          static_cast<std::uint32_t>(lower)});
      if (row < first_between) {
        between_start_[j] = entries_.size();
      } else {
        rows[row - first_between].push_back({j, entries_.size() - 1});
      }
      values[k] = used;
      used += at(stride_[row] * size_[j]);
      lower += at(stride_[row] * size_[j]);
    }
    entry_start_.push_back(entries_.size());
  }
  row_start_.assign(1, 0);
  row_between_.clear();
  row_entries_.clear();
  for (const auto& row : rows) {
    const auto between = std::ranges::lower_bound(row, first_between, {}, &RowEntry::column);
    row_between_.push_back(row_entries_.size() + static_cast<std::size_t>(between - row.begin()));
    row_entries_.insert(row_entries_.end(), row.begin(), row.end());
    row_start_.push_back(row_entries_.size());
  }
  if (used > std::numeric_limits<std::uint32_t>::max())
    throw std::length_error("a matrix of more than four thousand million numbers");
  matrix_.assign(used, 0.0);
  inverse_.assign(inverse, 0.0);
  lower_.assign(lower, 0.0F);
  stale_.assign(n, 1);
  return values;
}

}  // namespace keyblock::linalg
