#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/force_balance.h"
#include "model/model.h"

namespace keyblock::simulation {

/// Which blocks of a static stage move without bound.
///
/// A block is *moving* when it has gone 0.02 ℓ without coming nearer to balance by a tenth: what bends or closes until it carries its load
/// comes nearer as it goes.
/// Where joints have a stiffness of their own a block leans until they carry it: ten times the way on which a pair of trials foretells that it comes to
/// rest, at most 0.3 ℓ. *Candidates* are blocks that a pair of trials lets go far (suspect()). With the first of them that is moving,
/// the others are that have gone a tenth of its way: they are its mechanism. A block on supports cannot fall, and is never called moving.
class MovingBlocks {
 public:
  explicit MovingBlocks(const dynamics::Model& model);

  /// Everything that changes, for checkpoints.
  struct Memory {
    std::vector<double> travel_limit;  ///< m, per block, beyond which it is moving
    std::vector<double> travel;   ///< m, per block, since it was in balance, or came nearer to it by a tenth
    std::vector<double> nearest;  ///< per block, best balance since it was in balance
    std::vector<double> carried;  ///< per block, share of its weight in the last step before it was held
    std::vector<double> astray;   ///< m, per block, all that it went while out of balance
    std::vector<std::uint8_t> state;  ///< per block, State
    int candidates = 0;
  };
  [[nodiscard]] Memory& memory() { return memory_; }

  [[nodiscard]] bool moves(std::size_t b) const { return memory_.state[b] == State::moving; }
  [[nodiscard]] bool is_candidate(std::size_t b) const { return memory_.state[b] == State::candidate; }
  [[nodiscard]] bool has_candidates() const { return memory_.candidates > 0; }
  [[nodiscard]] double carried(std::size_t b) const { return memory_.carried[b]; }
  /// Takes over a static step; true when blocks are moving that were not before.
  bool go(const dynamics::ForceBalance& balance, std::span<const double> moved, double tolerance);
  /// The ways (m) of two trials with pseudo time steps of that ratio, squared.
  struct Trials {
    std::span<const double> ways, shorter_ways;
    double ratio;
  };
  /// Candidates from two trials: a block that moves without bound goes farther by the ratio, a block that rests on something goes equally far.
  /// contacts: of the last step. True when there are any.
  bool suspect(const Trials& trials, std::span<const contact::Contact> contacts);
  /// Forgets the candidates.
  void clear();
  /// m, the largest of all blocks that are not moving: how far they went while they were out of balance.
  [[nodiscard]] double astray() const;

 private:
  enum State : std::uint8_t { resting = 0, candidate = 1, moving = 2 };

  void find_leaning_limits(const Trials& trials, std::span<const contact::Contact> contacts);
  [[nodiscard]] double leaning_limit(double way, double shorter_way, double ratio) const;
  void follow(std::size_t b, const dynamics::ForceBalance& balance, double moved, double tolerance);

  const dynamics::Model& model_;
  bool closes_;                        ///< joints have a stiffness of their own
  std::vector<std::uint8_t> is_held_;  ///< per block: on supports
  Memory memory_;
};

}  // namespace keyblock::simulation
