#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

#include "contact/competition.h"

namespace keyblock::contact {

/// Accelerator: the contacts of two blocks stay the same as long as the blocks hardly move against each other.
///
/// Whether a candidate is a contact hangs on thresholds of a share of a block, while blocks in contact move by a millionth of a block in a step.
/// The least distance of any condition from its threshold, divided by the rate at which motion changes it, is the margin of the pair: m by
/// which both blocks together may move. Within the margin the contacts are read from BlockPair::steady.
class SteadyPairs {
 public:
  /// Has every pair searched in each step: slower, and the same contacts.
  void switch_off() { is_on_ = false; }
  [[nodiscard]] bool is_on() const { return is_on_; }

  /// Whether the contacts of the pair are still those of BlockPair::steady. Blocks that move together, as where the rock sways, have not
  /// moved; nor may they have at the end of the step, by the predicted displacement.
  [[nodiscard]] bool is_steady(const Surface& surface, const StepMotion& motion,
                               const BlockPair& pair) const {
    if (!is_on_) return false;
    const std::size_t a = at(pair.block_a), b = at(pair.block_b);
    double left = pair.steady.limit - motion.path[a] - motion.path[b];
    const Vec2 moved = apart(surface, pair) - pair.steady.apart;
    Vec2 will_have_moved = moved;
    if (!motion.predicted.empty()) {
      left -= motion.predicted_path[a] + motion.predicted_path[b];
      will_have_moved +=
          motion.predicted[at(surface.block_begin[b])] - motion.predicted[at(surface.block_begin[a])];
    }
    return left >= 0.0 && std::max(squared_norm(moved), squared_norm(will_have_moved)) <= left * left &&
           motion.reach[a] + motion.reach[b] <= pair.steady.reach;
  }
  /// m, from the first vertex of block a to the first vertex of block b.
  [[nodiscard]] static Vec2 apart(const Surface& surface, const BlockPair& pair) {
    const auto first = [&](int block) { return surface.position[at(surface.block_begin[at(block)])]; };
    return first(pair.block_b) - first(pair.block_a);
  }

 private:
  bool is_on_ = true;
};

/// The margin of a pair of blocks while its contacts are chosen: every decision takes its part of it.
class SteadyMargin {
 public:
  /// Of the candidates of the pair, before the competitors among them compete. Candidates end at `end`.
  SteadyMargin(const SteadyPairs& steady_pairs, const CornerView& view, const BlockPair& pair,
               std::size_t end, std::span<const Competitor> competitors);
  /// Where another block decides, no margin of the pair is known.
  void hangs_on_other_blocks() { margin_ = 0.0; }
  /// Of a competition, after it. competitors: the same as competed.
  void take(const CornerView& view, std::span<Competitor* const> competitors, const Outcome& outcome);
  /// Into pair.steady, where the margin is worth it. A pair that is not steady is tried again some steps later.
  void keep(const CornerView& view, std::span<const Competitor> competitors, BlockPair& pair) const;
  [[nodiscard]] double value() const { return margin_; }  ///< m; 0: not known

 private:
  static constexpr int steps_between_tries = 16;
  /// Of the reach now, up to which a steady pair is left alone. Larger: fewer searches as motion grows, and smaller margins.
  static constexpr double reach_share = 2.0;
  /// Of the reach: a smaller margin is not worth being steady for.
  static constexpr double least_share = 0.02;

  double reach_;  ///< m, of both blocks in the step
  bool tries_;
  double margin_;
};

}  // namespace keyblock::contact
