#pragma once
#include <string>

#include "study/plan.h"

namespace keyblock::study {

/// Whether a text is the key of a run, as run_key() makes it: `r0012-0123456789`. It names a folder.
bool is_run_key(const std::string& key);

/// What is wrong with a plan that was read from a file, which anybody may have written; empty: nothing. In a plan that is right, keys are
/// keys and no two are the same, runs have a value of every key of their axes, measures are known, and cells are no more than a plan has.
std::string mistake_in(const Plan& plan);

}  // namespace keyblock::study
