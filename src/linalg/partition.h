#pragma once
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace keyblock::linalg {

/// Order of the blocks: some parts that are not coupled with each other, and last the blocks between them. Parts are runs of levels
/// of a breadth-first search, each ended by a level of the last kind. The order depends on the pattern alone.
struct Partition {
  std::vector<int> order;  ///< place → block
  /// First place of every part; then of the blocks between, which may be none; then n.
  std::vector<std::size_t> begin;
};

/// Of n blocks that are coupled in these pairs. Few blocks are one part.
Partition partition(std::size_t n, std::span<const std::pair<int, int>> pairs);

}  // namespace keyblock::linalg
