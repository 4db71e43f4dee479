#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "solve/low_rank_update.h"
#include "solve/step_matrix.h"

namespace keyblock::dynamics {

/// Accelerator: the factor of a step serves the steps that follow, as long as it was made for the same inertia and nearly the same rows, and
/// few springs have to be updated. Where it failed, it is not tried for some steps, twice as many after each failure.
class KeptFactor {
 public:
  /// The next step factors its matrix, as after a restart or when the pattern has changed.
  void reset() {
    solver_ = nullptr;
    wait_ = 0;
    next_wait_ = 1;
  }
  /// At the start of a step: whether the factor of an earlier step is tried. Matrix and update then are of the rows of this step.
  bool begin_step(const StepSystem& system, StepMatrix& matrix, LowRankUpdate& update);
  /// The matrix of this step is being made; it may serve later ones.
  void note(const StepSystem& system);
  /// The next step does not try it.
  void drop() { solver_ = nullptr; }
  /// The factor at hand is that of an earlier step.
  [[nodiscard]] bool is_kept() const { return is_kept_; }
  void forget() { is_kept_ = false; }
  /// After the step, in which so many springs were updated: whether the factor is worth trying in the next one.
  void end_step(const OpenCloseResult& result, std::size_t updated);

 private:
  void note_rows(const StepSystem& system);
  [[nodiscard]] bool fits(const StepSystem& system) const;
  bool carry(const StepSystem& system, StepMatrix& matrix, LowRankUpdate& update);

  const linalg::BlockSolver* solver_ = nullptr;  ///< that has it; null: there is none
  std::vector<Coupling::RowKey> rows_;           ///< for which it was made
  std::uint64_t version_ = 0;                    ///< of these
  std::vector<double> inertia_;                  ///< per block
  bool is_kept_ = false;
  bool was_tried_ = false;          ///< in this step
  std::size_t updated_before_ = 0;  ///< springs, at the start of the step
  int wait_ = 0, next_wait_ = 1;    ///< steps until a factor is kept again; after the next failure
};

}  // namespace keyblock::dynamics
