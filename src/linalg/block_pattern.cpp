#include "linalg/block_pattern.h"

#include <algorithm>

#include "core/index.h"
#include "linalg/block_solver.h"
#include "linalg/minimum_degree.h"

namespace keyblock::linalg {

BlockPattern::BlockPattern(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = sizes.size();
  const std::vector<int> order = approximate_minimum_degree(static_cast<int>(n), pairs).order;
  position.assign(n, 0);
  size.assign(n, 0);
  stride.assign(n, 0);
  offset.assign(n, 0);
  std::vector<std::size_t> start(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) start[i + 1] = start[i] + at(sizes[i]);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t block = at(order[k]);
    position[block] = k;
    size[k] = sizes[block];
    stride[k] = padded_rows(sizes[block]);
    offset[k] = start[block];
  }
  equal_size =
      n > 0 && std::all_of(sizes.begin(), sizes.end(), [&](int s) { return s == sizes[0]; }) ? sizes[0] : 0;
  find_structure(pairs);
  find_updates();
  place_values();
}

// Row structure of every column: its own entries and the entries of its children in the elimination tree.
void BlockPattern::find_structure(std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = columns();
  std::vector<std::vector<std::size_t>> below(n), children(n);
  for (const auto& [i, j] : pairs) {
    const auto [low, high] = std::minmax(position[at(i)], position[at(j)]);
    below[low].push_back(high);
  }
  parent.assign(n, none);
  row_start.assign(1, 0);
  rows.clear();
  std::vector<std::size_t> seen(n, n);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<std::size_t> found;
    seen[j] = j;
    const auto add = [&](std::size_t row) {
      if (seen[row] == j) return;
      seen[row] = j;
      found.push_back(row);
    };
    for (const std::size_t row : below[j]) add(row);
    for (const std::size_t child : children[j]) {
      for (std::size_t e = row_start[child]; e < row_start[child + 1]; ++e) add(rows[e]);
    }
    std::sort(found.begin(), found.end());
    parent[j] = found.empty() ? none : found.front();
    if (parent[j] != none) children[parent[j]].push_back(j);
    rows.insert(rows.end(), found.begin(), found.end());
    row_start.push_back(rows.size());
  }
}

void BlockPattern::find_updates() {
  const std::size_t n = columns();
  above.assign(n, 0);
  for (std::size_t j = n; j-- > 0;) {
    if (parent[j] != none) above[j] = above[parent[j]] + at(stride[parent[j]]);
  }
  std::vector<std::size_t> count(n + 1, 0);
  for (const std::size_t row : rows) ++count[row + 1];
  for (std::size_t j = 0; j < n; ++j) count[j + 1] += count[j];
  update_start = count;
  updates.resize(rows.size());
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t e = row_start[k]; e < row_start[k + 1]; ++e) updates[count[rows[e]]++] = {k, e};
  }
}

void BlockPattern::place_values() {
  const std::size_t n = columns();
  column_value.resize(n);
  work_start.resize(n);
  row_value.resize(rows.size());
  std::size_t work = 0;
  for (std::size_t j = 0; j < n; ++j) {
    column_value[j] = values;
    work_start[j] = work;
    values += at(stride[j] * size[j]);
    work += at(stride[j]);
    for (std::size_t e = row_start[j]; e < row_start[j + 1]; ++e) {
      row_value[e] = values;
      values += at(stride[rows[e]] * size[j]);
    }
  }
  work_size = work + row_padding;  // the last numbers of a column are read as a whole register
}

}  // namespace keyblock::linalg
