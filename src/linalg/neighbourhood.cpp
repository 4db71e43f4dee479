#include "linalg/neighbourhood.h"

#include <algorithm>

#include "linalg/numbers.h"

namespace keyblock::linalg {

bool Neighbourhood::collect(const BlockOrder& order, const UpperPattern& pattern,
                            std::span<const std::size_t> blocks) {
  const std::size_t n = order.blocks();
  const auto most = static_cast<std::size_t>(numbers::most_local_share * static_cast<double>(n));
  if (blocks.size() > most) return false;
  positions_.clear();
  edge_.clear();
  state_.assign(n, State::outside);
  const auto reach = [&](std::size_t position, State state, std::vector<std::uint32_t>& list) {
    if (state_[position] != State::outside) return;
    state_[position] = state;
    list.push_back(static_cast<std::uint32_t>(position));
  };
  const auto reach_neighbours = [&](std::size_t k, State state, std::vector<std::uint32_t>& list) {
    for (const std::uint32_t position : pattern.neighbours(positions_[k])) reach(position, state, list);
  };
  for (const std::size_t block : blocks) reach(order.position[block], State::inside, positions_);
  std::size_t next = 0;
  for (int layer = 0; layer < numbers::local_layers; ++layer) {
    for (const std::size_t end = positions_.size(); next < end; ++next)
      reach_neighbours(next, State::inside, positions_);
    if (positions_.size() > most) return false;
  }
  for (; next < positions_.size(); ++next) reach_neighbours(next, State::at_edge, edge_);
  split_by_parts(order);
  return true;
}

/// Brings the positions into order, part by part.
void Neighbourhood::split_by_parts(const BlockOrder& order) {
  positions_.clear();
  for (std::size_t position = 0; position < state_.size(); ++position) {
    if (has(position)) positions_.push_back(static_cast<std::uint32_t>(position));
  }
  begin_.assign(1, 0);
  for (std::size_t piece = 1; piece < order.begin.size(); ++piece) {
    const auto end = std::lower_bound(positions_.begin(), positions_.end(), order.begin[piece]);
    const auto here = static_cast<std::size_t>(end - positions_.begin());
    if (piece == 1 || here > begin_.back()) begin_.push_back(here);
  }
}

}  // namespace keyblock::linalg
