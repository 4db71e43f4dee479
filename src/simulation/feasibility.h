#pragma once
#include <optional>
#include <string>

#include "simulation/setup.h"

namespace keyblock::simulation {

/// Why there is nothing to compute: rock that its weight, or the stress that an excavation releases, deforms by more than its own size, with
/// the numbers that say so. That is the same in any set of units.
std::optional<std::string> yields_without_limit(const RunSetup& setup);

}  // namespace keyblock::simulation
