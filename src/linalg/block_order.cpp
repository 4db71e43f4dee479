#include "linalg/block_order.h"

#include <algorithm>

#include "core/index.h"
#include "linalg/block_solver.h"
#include "linalg/partition.h"

namespace keyblock::linalg {

void BlockOrder::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  Partition found = partition(sizes.size(), pairs);
  begin = std::move(found.begin);
  block_at = std::move(found.order);
  position.resize(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) position[at(block_at[k])] = k;
  place_vectors(sizes);
}

void BlockOrder::place_vectors(std::span<const int> sizes) {
  std::vector<std::size_t> unknown(sizes.size() + 1, 0);
  for (std::size_t b = 0; b < sizes.size(); ++b) unknown[b + 1] = unknown[b] + at(sizes[b]);
  size.clear();
  stride.clear();
  offset.clear();
  start.clear();
  padded = 0;
  largest = 0;
  all_of_six = std::ranges::all_of(sizes, [](int s) { return s == 6; });
  for (const int block : block_at) {
    const int unknowns = sizes[at(block)];
    size.push_back(unknowns);
    stride.push_back(padded_rows(unknowns));
    offset.push_back(unknown[at(block)]);
    start.push_back(padded);
    padded += at(padded_rows(unknowns));
    largest = std::max(largest, padded_rows(unknowns));
  }
}

}  // namespace keyblock::linalg
