#include "simulation/moving_blocks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contact/joint_faces.h"
#include "core/index.h"
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
// Where joints have a stiffness of their own: of the block size, the farthest that a block may lean until they carry it; and of the way to rest that
// trials foretell. They leave out that joints go on opening and that weight leans over, which makes the way ten times as long at 0.9 of the limit.
constexpr double leaning_share = 0.3, leaning_ways = 10.0;
}  // namespace

MovingBlocks::MovingBlocks(const dynamics::Model& model)
    : model_(model), closes_(contact::JointFaces::are_there(model.laws)), is_held_(model.blocks.size(), 0) {
  for (const int block : dynamics::held_blocks(model)) is_held_[at(block)] = 1;
  memory_.travel_limit.assign(model.blocks.size(),
                              (closes_ ? leaning_share : travel_share) * model.block_size);
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
    any = any || (is_held_[b] == 0 && memory_.travel[b] > memory_.travel_limit[b]);
  }
  if (!any) return false;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    const double limit = memory_.travel_limit[b] * (is_candidate(b) ? along_share : 1.0);
    if (model_.moves(b) && is_held_[b] == 0 && memory_.travel[b] > limit) memory_.state[b] = State::moving;
  }
  clear();
  return true;
}

/// m. Trials of a block on springs k, with inertia c and c times the ratio, go F/(k + c) and F/(k + ratio c): it rests at F/k.
double MovingBlocks::leaning_limit(double way, double shorter_way, double ratio) const {
  const double least = travel_share * model_.block_size, most = leaning_share * model_.block_size,
               stiffer = ratio * shorter_way - way;
  if (!(stiffer * most > (ratio - 1.0) * way * shorter_way)) return least;
  return std::clamp(leaning_ways * (ratio - 1.0) * way * shorter_way / stiffer, least, most);
}

/// A block that others lean on, or that leans on others, goes as far as the farthest of them: from block to block that presses on it and goes
/// farther.
void MovingBlocks::find_leaning_limits(const Trials& trials, std::span<const contact::Contact> contacts) {
  std::vector<std::size_t> farther(model_.blocks.size());
  std::iota(farther.begin(), farther.end(), std::size_t{0});
  const auto look = [&](std::size_t b, std::size_t other) {
    if (model_.moves(other) && !moves(other) && trials.ways[other] > trials.ways[farther[b]])
      farther[b] = other;
  };
  for (const contact::Contact& c : contacts) {
    if (!(c.memory.normal_force > 0.0)) continue;
    look(at(c.block_a), at(c.block_b));
    look(at(c.block_b), at(c.block_a));
  }
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    std::size_t end = b;
    while (farther[end] != end) end = farther[end];
    memory_.travel_limit[b] = leaning_limit(trials.ways[end], trials.shorter_ways[end], trials.ratio);
  }
}

bool MovingBlocks::suspect(const Trials& trials, std::span<const contact::Contact> contacts) {
  const auto& [ways, shorter_ways, ratio] = trials;
  clear();
  if (closes_) find_leaning_limits(trials, contacts);
  const double farthest = *std::max_element(ways.begin(), ways.end());
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b) || moves(b) || is_held_[b] != 0) continue;
    const bool is_bounded = ways[b] <= unbounded_share * ratio * shorter_ways[b],
               is_far = ways[b] > (closes_ ? leaning_share : far_share) * model_.block_size;
    if (ways[b] <= least_of_farthest * farthest || (is_bounded && !is_far)) continue;
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
