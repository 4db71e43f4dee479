#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "solve/iterate.h"

namespace keyblock::dynamics {

/// Accelerator: where few blocks are out of balance, a Newton step moves these and those near them only, and all that it takes is looked at in
/// their rows and coefficients. For iterative solvers, in dynamic steps, where inertia keeps what happens local.
class LocalSolve {
 public:
  /// Whether it can be done in this step. In a static one, which has little inertia, a block moves all others.
  [[nodiscard]] static bool serves(const StepSystem& system) {
    return system.options.accelerators.local_solve && system.solver.local() != nullptr &&
           !system.problem.is_static();
  }
  void reset() { is_active_ = false; }
  /// direction ← −A⁻¹ gradient near the blocks that are out of balance by more than a share of `enough`. False, and nothing is done, where
  /// these are many. The solution is `active` afterwards, until the next call or reset().
  bool solve(const StepSystem& system, Iterate& iterate, double enough);
  [[nodiscard]] bool is_active() const { return is_active_; }
  /// What the direction of search does to the springs of the rows that it reaches.
  void find_direction(const StepSystem& system, Iterate& iterate) const;
  /// Blocks that move, and then those beside them.
  [[nodiscard]] std::span<const std::size_t> blocks() const { return blocks_; }
  [[nodiscard]] std::span<const std::size_t> moved_blocks() const { return blocks().first(moved_); }
  /// Of the blocks that move; a row of two of them comes once.
  [[nodiscard]] std::span<const std::size_t> rows() const { return rows_; }

 private:
  void find_rows_of_blocks(const StepSystem& system);
  void take_reach(const StepSystem& system);

  bool is_active_ = false;
  std::vector<std::size_t> blocks_;
  std::size_t moved_ = 0;
  std::vector<std::size_t> rows_;
  /// Rows of each unknown block; empty: not needed yet.
  std::vector<std::size_t> first_row_;
  std::vector<std::uint32_t> rows_of_block_;
  std::uint64_t version_ = 0;  ///< StepContacts::version of these
  // Scratch.
  linalg::LocalSolver::Reach reach_;
  std::vector<std::uint8_t> is_taken_;  ///< per unknown block
  std::vector<std::size_t> out_of_balance_;
};

}  // namespace keyblock::dynamics
