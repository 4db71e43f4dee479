#pragma once
#include <cstddef>
#include <optional>

#include "simulation/setup.h"

namespace keyblock::simulation {

/// The stage that excavates a block, by index; empty: none.
std::optional<std::size_t> excavating_stage(const RunSetup& setup, std::size_t block);

/// The block that a history follows: that of its name or, without one, of those that hold its point inside or on the boundary the one
/// that is excavated last, never before all. Empty: no block holds the point.
std::optional<std::size_t> history_block(const RunSetup& setup, const History& history);

}  // namespace keyblock::simulation
