#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "simulation/setup.h"

namespace keyblock::simulation {

/// The stage that excavates a block, by index; empty: none.
std::optional<std::size_t> excavating_stage(const RunSetup& setup, std::size_t block);

/// The block of a name that holds a point or, without a name, of those that hold the point inside or on the boundary the one that is
/// excavated last, never before all. Empty: no block does.
std::optional<std::size_t> block_at(const RunSetup& setup, const std::string& name, Vec2 point);

/// The block that a history follows.
inline std::optional<std::size_t> history_block(const RunSetup& setup, const History& history) {
  return block_at(setup, history.block, history.point);
}

}  // namespace keyblock::simulation
