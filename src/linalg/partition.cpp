#include "linalg/partition.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/index.h"
#include "linalg/numbers.h"

namespace keyblock::linalg {

namespace {

/// Cuts blocks in two, again and again.
class Dissection {
 public:
  Dissection(std::size_t n, std::span<const std::pair<int, int>> pairs)
      : neighbours_(n), piece_(n, 0), level_(n, 0), colour_(n, 0) {
    for (const auto& [i, j] : pairs) {
      neighbours_[at(i)].push_back(j);
      neighbours_[at(j)].push_back(i);
    }
  }

  void cut(std::vector<int> blocks) {
    ++pieces_;
    for (const int block : blocks) piece_[at(block)] = pieces_;
    // A second search, from where the first ended, has more and narrower levels.
    search(blocks);
    std::reverse(blocks.begin(), blocks.end());
    search(blocks);
    if (blocks.size() <= numbers::largest_part) {
      bring_apart(blocks);
      parts_.push_back(std::move(blocks));
      return;
    }
    // Not at the last level, beyond which nothing is left to cut off.
    const int middle = std::min(level_[at(blocks[blocks.size() / 2])], level_[at(blocks.back())] - 1);
    std::vector<int> before, after;
    for (const int block : blocks) {
      const int level = level_[at(block)];
      const bool continues = has_neighbour(block, [&](int k) { return level_[at(k)] > level; });
      (level > middle ? after : level == middle && continues ? between_ : before).push_back(block);
    }
    blocks = {};
    for (auto* side : {&before, &after}) {
      if (!side->empty()) cut(std::move(*side));
    }
  }

  Partition result() {
    std::sort(between_.begin(), between_.end());
    Partition result;
    const auto add = [&](const std::vector<int>& blocks) {
      result.begin.push_back(result.order.size());
      result.order.insert(result.order.end(), blocks.begin(), blocks.end());
    };
    add(between_);
    for (const std::vector<int>& part : parts_) add(part);
    result.begin.push_back(result.order.size());
    return result;
  }

 private:
  /// Whether a neighbour within the piece at hand is such.
  template <typename Is>
  [[nodiscard]] bool has_neighbour(int block, const Is& is) const {
    return std::ranges::any_of(neighbours_[at(block)],
                               [&](int k) { return piece_[at(k)] == pieces_ && is(k); });
  }

  /// Brings the piece at hand into the order of a breadth-first search from its first block, and finds how far each is from there.
  /// What is not coupled with it follows, a level later.
  void search(std::vector<int>& blocks) {
    for (const int block : blocks) level_[at(block)] = -1;
    std::vector<int> found;
    const auto reach = [&](int block, int level) {
      if (piece_[at(block)] != pieces_ || level_[at(block)] >= 0) return;
      level_[at(block)] = level;
      found.push_back(block);
    };
    int level = 0;
    std::size_t next = 0;
    for (const int start : blocks) {
      reach(start, level);
      for (; next < found.size(); ++next) {
        level = level_[at(found[next])] + 1;
        for (const int k : neighbours_[at(found[next])]) reach(k, level);
      }
    }
    blocks = std::move(found);
  }

  /// Orders the piece at hand level by level, and what is not coupled within a level together: a processor then need not wait for
  /// the block before.
  void bring_apart(std::vector<int>& blocks) {
    for (const int block : blocks) colour_[at(block)] = -1;
    for (const int block : blocks) {
      const auto is_taken = [&](int colour) {
        return has_neighbour(
            block, [&](int k) { return level_[at(k)] == level_[at(block)] && colour_[at(k)] == colour; });
      };
      int colour = 0;
      while (is_taken(colour)) ++colour;
      colour_[at(block)] = colour;
    }
    std::ranges::stable_sort(blocks, {},
                             [&](int block) { return std::pair(level_[at(block)], colour_[at(block)]); });
  }

  std::vector<std::vector<int>> neighbours_;
  std::vector<int> piece_;  ///< that a block was in last
  std::vector<int> level_, colour_;
  int pieces_ = 0;
  std::vector<std::vector<int>> parts_;
  std::vector<int> between_;
};

}  // namespace

Partition partition(std::size_t n, std::span<const std::pair<int, int>> pairs) {
  Dissection dissection(n, pairs);
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  dissection.cut(std::move(all));
  return dissection.result();
}

}  // namespace keyblock::linalg
