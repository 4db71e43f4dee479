#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "simulation/setup.h"

namespace keyblock::scenario {

/// Why the closure that is computed is a lower bound, in words; nothing where it is not, or nothing is excavated.
///
/// Blocks of order 1 have uniform strain. Where they fit each other at all corners they can hardly deform, unless they are small beside
/// the opening and the joints between them give way. It is a lower bound where most of the rock near an opening is in blocks of order
/// 1 that are larger than a fifth of its width, or where there are blocks of order 1 and joints stiffer than the default.
std::optional<std::string> closure_is_lower_bound(const Scenario& scenario,
                                                  const simulation::RunSetup& setup);

}  // namespace keyblock::scenario
