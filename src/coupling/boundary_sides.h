#pragma once
#include <span>
#include <vector>

#include "coupling/coupling.h"

namespace keyblock::dynamics {

struct BoundaryPoint;

/// The sides of a seismic boundary as elements, from left to right and from below: those of which some point is held or absorbs. An element
/// carries the resultant of what springs and dashpots of the side do, that is of its tractions beyond those before the run, and moves as far as its
/// points do in the mean, by their lengths.
class BoundarySides {
 public:
  explicit BoundarySides(std::span<const BoundaryPoint> points);

  [[nodiscard]] std::vector<Element> elements(std::span<const BoundaryPoint> points) const;
  /// tractions: Pa, of each point, beyond those before the run.
  [[nodiscard]] std::vector<Carried> carried(std::span<const BoundaryPoint> points,
                                             std::span<const Vec2> tractions, const Model& model,
                                             const State& state) const;

 private:
  struct Side {
    const char* name;
    std::size_t first, last;  ///< points at its ends
  };
  std::vector<Side> sides_;
  std::vector<int> side_of_;  ///< of each point; −1: none
};

}  // namespace keyblock::dynamics
