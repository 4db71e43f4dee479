#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "contact/candidates.h"
#include "contact/detection.h"
#include "contact/tolerances.h"
#include "coupling/attempt.h"

namespace keyblock::dynamics {

/// How far blocks may go in a step: the region in which its contacts are looked for, and where vertices are expected at its end.
///
///     reach = 2 |v| Δt + 2 |g − a| Δt²          of the fastest vertex of a block
///     turn  = min(2 |ω| Δt, reach / radius)
///
/// An attempt that leaves the region is not taken. The region then grows to 1.5 times what that attempt needed.
class PredictedMotion {
 public:
  explicit PredictedMotion(const Model& model);

  /// No block goes anywhere.
  void stay();
  /// Before the first attempt at a step. A static step: twice what each block went in the last one.
  void predict(const Model& model, const State& state, const Drive& drive, ThreadTeam& team);
  /// Whether a block moved or turned (`spin`: rad, per block) beyond the region, which is then made larger; its vertices are expected
  /// where the attempt took them.
  bool is_exceeded(const Attempt& attempt, std::span<const double> spin,
                   const contact::Tolerances& tolerances);
  /// The vertices of a block went by up to so much, m, against its first one.
  void add_path(std::size_t block, double length) { path_[block] += length; }

  /// m, per block.
  [[nodiscard]] std::span<const double> reach() const { return reach_; }
  /// m/s, per block: the fastest of its vertices at the start of the step.
  [[nodiscard]] std::span<const double> speed() const { return speed_; }
  /// What detection asks for. away: Candidates::away.
  [[nodiscard]] contact::StepMotion for_detection(std::span<const double> away, bool is_static) const;

 private:
  std::vector<double> reach_, turn_, path_;  ///< m, rad and m, per block: StepMotion
  std::vector<double> speed_;
  std::vector<Vec2> predicted_;           ///< m, per vertex: StepMotion::predicted
  std::vector<Vec2> predicted_at_first_;  ///< m, the same in the first attempt; empty: this is it
  std::vector<double> differs_;           ///< m, per block: StepMotion::predicted_path
  std::vector<std::uint8_t> is_far_;      ///< per block: it left its region. Scratch
};

}  // namespace keyblock::dynamics
