#include "linalg/partition.h"

#include <algorithm>

#include "core/index.h"

namespace keyblock::linalg {

namespace {

constexpr std::size_t parts = 8;            // into which a large system is cut
constexpr std::size_t worth_parts = 4'000;  // blocks

/// Blocks in the order of a breadth-first search, and how far each is from where it began. Pieces that are not coupled follow each
/// other, a level apart.
struct Levels {
  std::vector<int> order, level;
};

Levels breadth_first(const std::vector<std::vector<int>>& neighbours, int root) {
  const std::size_t n = neighbours.size();
  Levels found{{}, std::vector<int>(n, -1)};
  const auto reach = [&](int block, int level) {
    if (found.level[at(block)] >= 0) return;
    found.level[at(block)] = level;
    found.order.push_back(block);
  };
  reach(root, 0);
  int unseen = 0;
  for (std::size_t next = 0; next < n; ++next) {
    if (next == found.order.size()) {
      while (found.level[at(unseen)] >= 0) ++unseen;
      reach(unseen, found.level[at(found.order.back())] + 1);
    }
    const int here = found.order[next];
    for (const int k : neighbours[at(here)]) reach(k, found.level[at(here)] + 1);
  }
  return found;
}

}  // namespace

Partition partition(std::size_t n, std::span<const std::pair<int, int>> pairs) {
  Partition result;
  if (n < worth_parts) {
    for (std::size_t k = 0; k < n; ++k) result.order.push_back(static_cast<int>(k));
    result.begin = {0, n, n};
    return result;
  }
  std::vector<std::vector<int>> neighbours(n);
  for (const auto& [i, j] : pairs) {
    neighbours[at(i)].push_back(j);
    neighbours[at(j)].push_back(i);
  }
  // A second search, from where the first ended, has more and narrower levels.
  const Levels levels = breadth_first(neighbours, breadth_first(neighbours, 0).order.back());
  const auto level_of = [&](std::size_t place) { return levels.level[at(levels.order[place])]; };
  std::vector<int> between;
  result.begin.push_back(0);
  for (std::size_t first = 0, last = 0; first < n; first = last) {
    while (last < n && level_of(last) == level_of(first)) ++last;
    const bool ends_a_part = last < n && first >= result.begin.size() * n / parts;
    std::vector<int>& target = ends_a_part ? between : result.order;
    for (std::size_t k = first; k < last; ++k) target.push_back(levels.order[k]);
    if (ends_a_part) result.begin.push_back(result.order.size());
  }
  result.begin.push_back(result.order.size());
  // Within a part in the order of the caller's vectors.
  const auto place = [&](std::size_t k) { return result.order.begin() + static_cast<std::ptrdiff_t>(k); };
  for (std::size_t k = 0; k + 1 < result.begin.size(); ++k)
    std::sort(place(result.begin[k]), place(result.begin[k + 1]));
  std::sort(between.begin(), between.end());
  result.order.insert(result.order.end(), between.begin(), between.end());
  result.begin.push_back(n);
  return result;
}

}  // namespace keyblock::linalg
