#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// [n]: blocks of order n that are there and not fixed.
std::vector<int> blocks_by_order(const dynamics::Model& model);

/// Chooses the order of the blocks whose order is "auto", at the equilibria of a settling stage.
///
/// Error indicator of a block of order n ≥ 2: the stress that its terms of degree n carry, RMS over the block, over the RMS stress
/// of all blocks that move:
///
///     η² = (1/A) ∫ |S(a) − S(a without degree n)|² dA / (Σ ∫ |S|² dA / Σ A)
///
/// Above the stress accuracy the order is raised by one, below a quarter of it lowered. What degree n carries is an upper
/// estimate of what degree n + 1 would, where the series converges. A stage begins with every such block at order 2 at
/// least, so that there is something to look at; a block that was lowered in a stage stays.
class OrderControl {
 public:
  explicit OrderControl(const RunSetup& setup) : setup_(setup) {}

  /// Whether any order is left to the program.
  [[nodiscard]] bool active() const;

  /// What a restart needs.
  struct Memory {
    std::vector<int> orders;            ///< per block of the model; empty: as set up
    std::vector<std::uint8_t> lowered;  ///< per block, in the stage at hand
  };
  [[nodiscard]] Memory& memory() { return memory_; }

  /// Raises blocks of order 1 at the start of a settling stage; true when orders have changed.
  bool begin(dynamics::Model& model, dynamics::State& state);
  /// Looks at an equilibrium; true when orders have changed, and the rock has to settle again.
  bool adapt(dynamics::Model& model, dynamics::State& state);
  /// Gives the model the orders of the memory.
  void restore(dynamics::Model& model) const;
  /// η of every block; 0 for those of order 1.
  [[nodiscard]] static std::vector<double> indicators(const dynamics::Model& model,
                                                      const dynamics::State& state);

 private:
  [[nodiscard]] bool chooses(const dynamics::Model& model, std::size_t b) const;
  bool apply(dynamics::Model& model, dynamics::State& state, std::vector<int> orders);

  const RunSetup& setup_;
  Memory memory_;
};

}  // namespace keyblock::simulation
