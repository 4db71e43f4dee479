#pragma once
#include <optional>
#include <string>

#include "simulation/setup.h"

namespace keyblock::simulation {

/// How far the stress that a run brings closes the softest joint between blocks that move. The stress is that of their weight over their
/// height, or what an excavation releases: an upper bound.
struct JointClosure {
  double closure = 0.0;     ///< m
  double block_size = 0.0;  ///< m, √ of the mean area of the blocks that move
  double stress = 0.0;      ///< Pa
  double stiffness = 0.0;   ///< Pa/m, normal
  [[nodiscard]] double share() const { return block_size > 0.0 ? closure / block_size : 0.0; }
};
[[nodiscard]] JointClosure largest_closure(const RunSetup& setup);

/// Shares of the block size: from the first on blocks sink so far into each other that what they carry is not told any more, beyond the
/// second they go through each other.
constexpr double soft_joint_closure = 0.02, most_joint_closure = 0.1;

/// Why there is nothing to compute, with the numbers that say so, the same in any set of units: rock that its weight, or the stress that an
/// excavation releases, deforms by more than its own size; joints that it closes by a tenth of the block size.
std::optional<std::string> yields_without_limit(const RunSetup& setup);

/// What the memory of a run is for, where there is not enough of it.
[[nodiscard]] std::string memory_purpose(const RunSetup& setup);

}  // namespace keyblock::simulation
