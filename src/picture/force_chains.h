#pragma once
#include <vector>

#include "record/record.h"

namespace keyblock::picture {

/// What two blocks press on each other with: the sum of the normal forces of their contacts, and where it acts.
struct ForceChain {
  int block_a = 0, block_b = 0;  ///< a < b
  double force = 0.0;            ///< N per thickness, above 0
  Vec2 middle;                   ///< m, local: where the resultant goes through the joint
  /// How far that is from the middle of the joint, over half its length: ±1 at its ends, 0 where that is not known.
  double eccentricity = 0.0;

  /// The joint turns about one of its ends.
  [[nodiscard]] bool is_hinge() const;
};

/// Of all pairs of blocks that press on each other, by their numbers.
std::vector<ForceChain> force_chains(const record::ContactFrame& contacts);

/// A piece of a line of thrust: through a block that is pressed by two others, between the resultants.
struct Thrust {
  int block = 0;
  Vec2 from, to;
  double force = 0.0;  ///< the larger one
};
std::vector<Thrust> lines_of_thrust(const record::ModelRecord& model, const std::vector<ForceChain>& chains);

}  // namespace keyblock::picture
