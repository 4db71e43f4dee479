#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "cutting/block_system.h"

namespace keyblock::cutting {

/// The joint between two blocks that have one of their own; none: there is no such interface.
std::optional<EdgeLabel> joint_between(const BlockSystem& system, std::size_t one, std::size_t other);

/// Whether a joint is that of an interface.
bool is_of_interface(const BlockSystem& system, EdgeLabel joint);

/// What an edge of a block has in common with the other block of an interface.
struct InterfaceFace {
  std::size_t block = 0, ring = 0, edge = 0;
  double from = 0.0, to = 1.0;  ///< as shares of the edge
  EdgeLabel joint;
};

/// All of them, on both sides, in the order of the interfaces. Edges face each other where they are less than a thousandth of the block size
/// apart.
std::vector<InterfaceFace> interface_faces(const BlockSystem& system);

/// Gives edges of which more than half lies along an interface its label, for pictures: contacts have it by their blocks.
void label_interfaces(BlockSystem& system);

}  // namespace keyblock::cutting
