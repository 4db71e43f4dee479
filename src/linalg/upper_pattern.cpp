#include "linalg/upper_pattern.h"

#include <algorithm>
#include <numeric>

#include "core/index.h"
#include "linalg/paired_columns.h"

namespace keyblock::linalg {

void UpperPattern::analyse(const BlockOrder& order, std::span<const std::pair<int, int>> pairs) {
  find_neighbours(order, pairs);
  place_blocks(order, pairs);
}

void UpperPattern::find_neighbours(const BlockOrder& order, std::span<const std::pair<int, int>> pairs) {
  const std::vector<std::size_t>& position = order.position;
  neighbour_start.assign(order.blocks() + 1, 0);
  for (const auto& [i, j] : pairs) {
    ++neighbour_start[position[at(i)] + 1];
    ++neighbour_start[position[at(j)] + 1];
  }
  std::partial_sum(neighbour_start.begin(), neighbour_start.end(), neighbour_start.begin());
  neighbour.resize(neighbour_start.back());
  std::vector<std::size_t> next(neighbour_start.begin(), neighbour_start.end() - 1);
  for (const auto& [i, j] : pairs) {
    neighbour[next[position[at(i)]]++] = static_cast<std::uint32_t>(position[at(j)]);
    neighbour[next[position[at(j)]]++] = static_cast<std::uint32_t>(position[at(i)]);
  }
}

std::size_t UpperPattern::scaled_count(const BlockOrder& order, std::size_t i, std::size_t j) {
  return order.all_of_six ? std::size_t{paired_columns::block_size} : at(order.stride[i] * order.size[j]);
}

void UpperPattern::place_blocks(const BlockOrder& order, std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = order.blocks(), between = order.between();
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> above(n);  // row, pair
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [low, high] =
        std::minmax(order.position[at(pairs[k].first)], order.position[at(pairs[k].second)]);
    above[high].emplace_back(low, k);
  }
  for (std::vector<std::size_t>* starts : {&diagonal, &inverse_start, &above_start}) starts->clear();
  row.clear();
  column_start.assign(1, 0);
  own_start.clear();
  pair_value.assign(pairs.size(), 0);
  values = inverses = scaled = copied = 0;
  std::vector<std::vector<RowEntry>> of_row(between);
  for (std::size_t j = 0; j < n; ++j) {
    diagonal.push_back(values);
    inverse_start.push_back(inverses);
    above_start.push_back(scaled);
    values += at(order.stride[j] * order.size[j]);
    inverses += at(order.stride[j] * order.size[j]);
    std::sort(above[j].begin(), above[j].end());
    own_start.push_back(static_cast<std::uint32_t>(row.size()));
    for (const auto& [i, k] : above[j]) {
      row.push_back(static_cast<std::uint32_t>(i));
      if (i < between && j >= between) {
        of_row[i].push_back({j, values, scaled, 0});
        own_start[j] = static_cast<std::uint32_t>(row.size());
      }
      pair_value[k] = values;
      values += at(order.stride[i] * order.size[j]);
      scaled += scaled_count(order, i, j);
    }
    column_start.push_back(static_cast<std::uint32_t>(row.size()));
  }
  row_start.assign(1, 0);
  row_entries.clear();
  for (std::size_t i = 0; i < of_row.size(); ++i) {
    for (RowEntry entry : of_row[i]) {
      entry.copy = copied;
      row_entries.push_back(entry);
      copied += scaled_count(order, i, entry.column);
    }
    row_start.push_back(row_entries.size());
  }
}

}  // namespace keyblock::linalg
