#pragma once
#include <span>
#include <string>
#include <vector>

#include "simulation/rock_sample.h"

namespace keyblock::simulation {

/// A joint that meets a free-field side and that the rock beside the model does not slip on.
struct HeldJoint {
  std::string joint;  ///< the set or map that it is of
  ColumnSide side{};
  double height = 0.0;  ///< m, where it meets the side
  double dip = 0.0;     ///< degrees, downwards to the right
  double length = 0.0;  ///< m, that it goes on inside
  double mobilized =
      0.0;  ///< largest share of its strength that the shaking asks for in rock that is elastic
};

struct FarJoints {
  std::vector<FarPlane> planes;  ///< of joints from side to side, at most 10° steep, at least half mobilized
  std::vector<HeldJoint> held;   ///< of all others, the most mobilized of each set or map
  std::vector<JointPiece> others;  ///< what is in no plane
};

/// What joints at free-field sides do under the ground motions of the stages, whose columns are run ahead, elastic. setup.boundary must be
/// there, with its layers.
FarJoints far_joints(const RunSetup& setup, std::span<const JointPiece> pieces);

}  // namespace keyblock::simulation
