#pragma once

namespace keyblock::simulation {

/// How far a stage is after a step.
struct StageOutlook {
  long steps_left = 0;       ///< 0: it has ended; of a static stage, at most
  double fraction = 0.0;     ///< done of it, 0 … 1; an estimate of a static stage
  double worst_ratio = 0.0;  ///< static: largest residual of a block over its weight
};

}  // namespace keyblock::simulation
