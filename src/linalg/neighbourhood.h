#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/upper_pattern.h"

namespace keyblock::linalg {

/// Some blocks and the blocks near them, of which a system may be. What a change does beyond is left over in the residual.
class Neighbourhood {
 public:
  /// The given blocks, and numbers::local_layers layers of blocks around them. False where they are so many that a system of all blocks is as
  /// well.
  [[nodiscard]] bool collect(const BlockOrder& order, const UpperPattern& pattern,
                             std::span<const std::size_t> blocks);
  /// Ascending: those between the parts, and then part by part.
  [[nodiscard]] std::span<const std::uint32_t> positions() const { return positions_; }
  /// Piece 0: those between the parts, be it empty; then for every part that has some.
  [[nodiscard]] std::span<const std::uint32_t> piece(std::size_t k) const {
    return positions().subspan(begin_[k], begin_[k + 1] - begin_[k]);
  }
  [[nodiscard]] std::size_t pieces() const { return begin_.size() - 1; }
  /// Positions that are coupled with these, and not of them.
  [[nodiscard]] std::span<const std::uint32_t> edge() const { return edge_; }
  [[nodiscard]] bool has(std::size_t position) const { return state_[position] == State::inside; }

 private:
  enum class State : std::uint8_t { outside, inside, at_edge };
  void split_by_parts(const BlockOrder& order);

  std::vector<std::uint32_t> positions_;
  std::vector<std::size_t> begin_;  ///< of the pieces, into positions_
  std::vector<std::uint32_t> edge_;
  std::vector<State> state_;  ///< per position
};

}  // namespace keyblock::linalg
