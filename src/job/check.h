#pragma once
#include <string>
#include <vector>

#include "scenario/build.h"
#include "scenario/scenario.h"

namespace keyblock::job {

/// What can be known of a run before it starts.
struct Checked {
  scenario::BlockModel blocks;
  std::vector<std::string> warnings;  ///< of the study, if there is one, too
  std::vector<std::string> notes;     ///< what the rock around the model is taken to be
};

/// Looks at files, blocks and model. Throws InputError with all mistakes, those of files before any block is cut, and RunError where the
/// model cannot be built. A scenario without stages can still be cut.
Checked check(const scenario::Scenario& scenario, int realization);

}  // namespace keyblock::job
