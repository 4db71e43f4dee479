#include "simulation/moving_blocks.h"

#include <algorithm>
#include <cmath>

#include "coupling/coupling.h"

namespace keyblock::simulation {

namespace {
constexpr double travel_share =
    0.02;                            // of the block size: way out of balance, beyond which a block is moving
constexpr double along_share = 0.1;  // of the same: of the other candidates that are moving then
constexpr double nearer =
    0.9;  // of the best balance of a block so far: one that comes to that is on its way to equilibrium
constexpr double unbounded_share =
    4.0 / 9.0;                              // of the ratio of two trials, above which a way is without bound
constexpr double far_share = 0.03;          // of the block size: a way in a trial that is far in any case
constexpr double least_of_farthest = 0.05;  // of the farthest block of a trial
}  // namespace

MovingBlocks::MovingBlocks(const dynamics::Model& model)
    : model_(model), travel_limit_(model.blocks.size(), travel_share * model.block_size) {
  for (const int block : dynamics::held_blocks(model))
    travel_limit_[static_cast<std::size_t>(block)] = HUGE_VAL;
  memory_.travel.assign(model.blocks.size(), 0.0);
  memory_.nearest.assign(model.blocks.size(), HUGE_VAL);
  memory_.carried.assign(model.blocks.size(), 1.0);
  memory_.astray.assign(model.blocks.size(), 0.0);
  memory_.state.assign(model.blocks.size(), State::resting);
}

/// How far a block has gone without coming nearer to balance.
void MovingBlocks::follow(std::size_t b, const dynamics::ForceBalance& balance, double moved,
                          double tolerance) {
  const double ratio = balance[b].ratio;
  memory_.carried[b] = std::clamp(1.0 - balance[b].falling, 0.0, 1.0);
  const bool balances = balance.balances(b, tolerance);
  if (!balances) memory_.astray[b] += moved;
  if (balances || ratio <= nearer * memory_.nearest[b]) {
    memory_.nearest[b] = balances ? HUGE_VAL : ratio;
    memory_.travel[b] = 0.0;
  } else {
    memory_.travel[b] += moved;
  }
}

bool MovingBlocks::go(const dynamics::ForceBalance& balance, std::span<const double> moved,
                      double tolerance) {
  bool any = false;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b) || moves(b)) continue;
    follow(b, balance, moved[b], tolerance);
    any = any || memory_.travel[b] > travel_limit_[b];
  }
  if (!any) return false;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    const double limit = travel_limit_[b] * (is_candidate(b) ? along_share : 1.0);
    if (model_.moves(b) && memory_.travel[b] > limit) memory_.state[b] = State::moving;
  }
  clear();
  return true;
}

bool MovingBlocks::suspect(std::span<const double> ways, std::span<const double> shorter_ways, double ratio) {
  clear();
  const double farthest = *std::max_element(ways.begin(), ways.end());
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b) || moves(b) || travel_limit_[b] == HUGE_VAL) continue;
    if (ways[b] <= least_of_farthest * farthest) continue;
    if (ways[b] <= unbounded_share * ratio * shorter_ways[b] && ways[b] <= far_share * model_.block_size)
      continue;
    memory_.state[b] = State::candidate;
    ++memory_.candidates;
  }
  return has_candidates();
}

void MovingBlocks::clear() {
  std::replace(memory_.state.begin(), memory_.state.end(), std::uint8_t{State::candidate},
               std::uint8_t{State::resting});
  memory_.candidates = 0;
}

double MovingBlocks::astray() const {
  double most = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (model_.moves(b) && !moves(b)) most = std::max(most, memory_.astray[b]);
  }
  return most;
}

}  // namespace keyblock::simulation
