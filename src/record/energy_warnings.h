#pragma once
#include <string>
#include <vector>

#include "record/record.h"

namespace keyblock::record {

/// Energy::residual_ratio of a run, above which its results are to be looked at with other eyes …
inline constexpr double doubtful_residual = 0.01;
/// … and above which they are none: forces and motion do not belong together.
inline constexpr double failed_residual = 0.05;
/// MadeEnergy::ratio, above which the time integration drives what moves.
inline constexpr double doubtful_made = 0.1;
/// MadeEnergy::share, above which the results are none: most of what moved has its energy from nothing.
inline constexpr double failed_made = 0.5;

/// What the balance of energies says against the results of a run, in plain words; empty: nothing.
[[nodiscard]] std::vector<std::string> energy_warnings(const RunRecord& run);

/// Why energies say that the results are none, one text each: the residual is above `failed_residual`, or no number; the rule of integration has made
/// more than `failed_made`. A run that was interrupted is judged once it has ended.
[[nodiscard]] std::vector<std::string> failed_balances(const RunRecord& run);

}  // namespace keyblock::record
