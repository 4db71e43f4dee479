#pragma once
#include <string>
#include <vector>

#include "record/record.h"

namespace keyblock::record {

/// Why the numbers of a run are not to be trusted, each in words: what its own checks have found that no input explains. Empty: nothing.
/// Commands end with exit code 2 where there is something, and outputs list it (docs/guide/results.md, "Errors of the computation").
[[nodiscard]] std::vector<std::string> computation_errors(const RunRecord& run);

/// After the results are written: throws a RunError with the reasons, if there are any.
void check_computation(const RunRecord& run);

/// As one text, for a message; empty: there are none.
[[nodiscard]] std::string computation_errors_text(const std::vector<std::string>& errors);

}  // namespace keyblock::record
