#pragma once
#include <functional>
#include <span>
#include <vector>

#include "contact/candidates.h"
#include "contact/surface.h"
#include "dynamics/rotation_correction.h"
#include "geometry/vec2.h"

namespace keyblock::dynamics {

/// Blocks that a step takes into others where no contact holds them: what contact detection has missed, because the step is too long for the
/// speed and the turn of the blocks. It knows of no contact rule; it only asks where vertices come to lie.
class Intrusions {
 public:
  /// Of the smaller block's size, √ of its area: how deep a vertex may come to lie in another block.
  static constexpr double most_share = 0.02;
  /// Of that depth: what the step itself must add. What lay there before is not for a shorter step to mend.
  static constexpr double least_added = 0.5;

  /// sizes: m, √ of the area of each block.
  explicit Intrusions(std::vector<double> sizes);

  /// A step, as it would end.
  struct Step {
    const contact::Surface& surface;     ///< at its start
    std::span<const Vec2> displacement;  ///< m, per vertex, in the step; of a fixed block 0
    std::span<const Vec2> prescribed;  ///< m, per block, of fixed blocks that are moved; empty: there is none
    const std::function<Vec2(std::size_t)>& at_end;  ///< m, where a vertex comes to be
    /// m, how deep contacts explain that the vertex lies in the block: infinite where one presses on it there, else, in a static step, the
    /// closure of joints between the two blocks.
    const std::function<double(int vertex, int block)>& explained;
  };
  /// Whether there is one among these pairs of blocks.
  [[nodiscard]] bool any(const Step& step, const contact::CandidateList& candidates);

 private:
  [[nodiscard]] bool all_go_little(const Step& step) const;
  void measure(const Step& step);
  [[nodiscard]] bool comes_in(const Step& step, int vertex, int block, double deepest) const;

  std::vector<double> size_;
  double least_size_;
  std::vector<Vec2> first_;      ///< m, per block: displacement of its first vertex
  std::vector<double> differs_;  ///< m, per block: by how much another one's way differs from that at most
};

/// Whether a block comes to lie in another one where no contact holds it.
bool comes_inside(const Attempt& attempt, const RotationCorrection& rotation, Intrusions& intrusions);

}  // namespace keyblock::dynamics
