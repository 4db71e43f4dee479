#pragma once
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace keyblock::linalg {

/// Order of the blocks: parts that are not coupled with each other, after the blocks between them. A system is cut in two at the
/// middle level of a breadth-first search, and so are its halves, until parts are small enough for a cache. The order depends on
/// the pattern alone.
struct Partition {
  std::vector<int> order;  ///< position → block
  std::vector<std::size_t>
      begin;  ///< 0; first position of every part, which is the end of what is before it; n
};

/// Of n blocks that are coupled in these pairs.
Partition partition(std::size_t n, std::span<const std::pair<int, int>> pairs);

}  // namespace keyblock::linalg
