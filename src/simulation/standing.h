#pragma once
#include "simulation/record.h"

namespace keyblock::simulation {

/// How blocks around no opening are at the end of a stage, judged from its record in this order:
///
/// | word | when |
/// |---|---|
/// | collapsed | blocks have fallen |
/// | moves | a static stage left blocks moving; a dynamic one, blocks faster than `still`, m/s |
/// | unsettled | a static stage ended without equilibrium |
/// | stands | else |
Standing standing_of(const StageRecord& stage, double still);

/// In files.
const char* standing_name(Standing standing);

}  // namespace keyblock::simulation
