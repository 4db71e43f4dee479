// Where the blocks of a matrix and of its factor are.
#include <algorithm>

#include "linalg/block_cholesky.h"
#include "linalg/minimum_degree.h"

namespace keyblock::linalg {

void BlockCholesky::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = sizes.size();
  const std::vector<int> order = approximate_minimum_degree(static_cast<int>(n), pairs).order;
  position_.assign(n, 0);
  size_.assign(n, 0);
  stride_.assign(n, 0);
  offset_.assign(n, 0);
  std::vector<std::size_t> start(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) start[i + 1] = start[i] + at(sizes[i]);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t block = at(order[k]);
    position_[block] = k;
    size_[k] = sizes[block];
    stride_[k] = padded_rows(sizes[block]);
    offset_[k] = start[block];
  }
  equal_size_ = n > 0 && std::all_of(sizes.begin(), sizes.end(), [&](int size) { return size == sizes[0]; })
                    ? sizes[0]
                    : 0;
  find_structure(pairs);
  place_values();
  place_matrix(pairs);
}

void BlockCholesky::place_matrix(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = size_.size();
  std::vector<std::vector<std::size_t>> pairs_of(n);  // by column
  const auto column_and_row = [&](std::size_t k) {
    return std::pair<std::size_t, std::size_t>(
        std::minmax(position_[at(pairs[k].first)], position_[at(pairs[k].second)]));
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) pairs_of[column_and_row(k).first].push_back(k);
  std::vector<std::size_t> place(pairs.size()), by_column(n);
  std::size_t used = 0;
  sources_.clear();
  source_start_.assign(1, 0);
  const auto add = [&](std::size_t to, int count) {
    sources_.push_back({used, to, at(count)});
    used += at(count);
    return sources_.back().from;
  };
  for (std::size_t j = 0; j < n; ++j) {
    by_column[j] = add(column_value_[j], stride_[j] * size_[j]);
    std::sort(pairs_of[j].begin(), pairs_of[j].end(), [&](std::size_t k, std::size_t l) {
      return column_and_row(k).second < column_and_row(l).second;
    });
    for (const std::size_t k : pairs_of[j]) {
      const std::size_t row = column_and_row(k).second;
      const auto first = rows_.begin() + static_cast<std::ptrdiff_t>(row_start_[j]);
      const auto last = rows_.begin() + static_cast<std::ptrdiff_t>(row_start_[j + 1]);
      const auto entry = static_cast<std::size_t>(std::lower_bound(first, last, row) - rows_.begin());
      place[k] = add(row_value_[entry], stride_[row] * size_[j]);
    }
    source_start_.push_back(sources_.size());
  }
  matrix_.assign(used, 0.0);
  stale_.assign(n, 1);
  diagonal_.resize(n);
  for (std::size_t i = 0; i < n; ++i) diagonal_[i] = by_column[position_[i]];
  slots_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [i, j] = pairs[k];
    const bool i_below = position_[at(i)] > position_[at(j)];
    const std::size_t row = position_[at(i_below ? i : j)];
    slots_.push_back({&matrix_[place[k]], stride_[row], i_below ? i : j, i_below ? j : i});
  }
}

// Row structure of every column: its own entries and those of the columns whose parent it is (elimination
// tree).
void BlockCholesky::find_structure(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = size_.size();
  std::vector<std::vector<std::size_t>> below(n), children(n);
  for (const auto& [i, j] : pairs) {
    const auto [low, high] = std::minmax(position_[at(i)], position_[at(j)]);
    below[low].push_back(high);
  }
  parent_.assign(n, none);
  row_start_.assign(1, 0);
  rows_.clear();
  std::vector<std::size_t> seen(n, n);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<std::size_t> rows;
    seen[j] = j;
    const auto add = [&](std::size_t row) {
      if (seen[row] == j) return;
      seen[row] = j;
      rows.push_back(row);
    };
    for (const std::size_t row : below[j]) add(row);
    for (const std::size_t child : children[j]) {
      for (std::size_t e = row_start_[child]; e < row_start_[child + 1]; ++e) add(rows_[e]);
    }
    std::sort(rows.begin(), rows.end());
    parent_[j] = rows.empty() ? none : rows.front();
    if (parent_[j] != none) children[parent_[j]].push_back(j);
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    row_start_.push_back(rows_.size());
  }
  above_.assign(n, 0);
  for (std::size_t j = n; j-- > 0;) {
    if (parent_[j] != none) above_[j] = above_[parent_[j]] + at(stride_[parent_[j]]);
  }
  std::vector<std::size_t> count(n + 1, 0);
  for (const std::size_t row : rows_) ++count[row + 1];
  for (std::size_t j = 0; j < n; ++j) count[j + 1] += count[j];
  update_start_ = count;
  updates_.resize(rows_.size());
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t e = row_start_[k]; e < row_start_[k + 1]; ++e) updates_[count[rows_[e]]++] = {k, e};
  }
}

void BlockCholesky::place_values() {
  const std::size_t n = size_.size();
  std::size_t value = 0, work = 0;
  column_value_.resize(n);
  work_start_.resize(n);
  row_value_.resize(rows_.size());
  for (std::size_t j = 0; j < n; ++j) {
    column_value_[j] = value;
    work_start_[j] = work;
    value += at(stride_[j] * size_[j]);
    work += at(stride_[j]);
    for (std::size_t e = row_start_[j]; e < row_start_[j + 1]; ++e) {
      row_value_[e] = value;
      value += at(stride_[rows_[e]] * size_[j]);
    }
  }
  values_.assign(value, 0.0);
  const std::size_t largest = n == 0 ? 0 : at(*std::max_element(stride_.begin(), stride_.end()));
  solved_.assign(largest, 0.0);
  scale_.assign(largest, 0.0);
  work_.assign(work + row_padding, 0.0);  // the last numbers of a column are read as a whole register
  target_.assign(n, nullptr);
}

}  // namespace keyblock::linalg
