#pragma once
#include <string_view>
#include <vector>

#include "verification/expression.h"
#include "verification/simulate.h"

namespace keyblock::verification {

/// A figure of a column of the histories; `arguments` begin with its name:
///     end, first          last and first value
///     at(c, t)            at a time, linear between rows (in static stages, where time stands, the last)
///     after('stage', c)   at the end of a stage
///     max, min, maxabs, mean
///     crossing(c, value)  time at which the value is first reached or passed, linear between rows
///     period(c)           mean time between crossings of the mean in one direction
/// Throws std::runtime_error when there is no such column, time or crossing.
double history_quantity(const Outcome& outcome, std::string_view function,
                        const std::vector<Argument>& arguments);

}  // namespace keyblock::verification
