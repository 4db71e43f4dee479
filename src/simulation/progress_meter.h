#pragma once
#include <chrono>

#include "record/record.h"
#include "simulation/checkpoint.h"
#include "simulation/setup.h"
#include "simulation/stage_outlook.h"

namespace keyblock::simulation {

/// Tells an observer how the stage at hand goes on: after its last step, and before that not more often than asked for.
class ProgressMeter {
 public:
  /// interval: s of wall time.
  ProgressMeter(const RunSetup& setup, double interval, record::RunObserver& observer)
      : setup_(setup), interval_(interval), observer_(observer) {}

  /// A stage begins, or goes on after `first_step` steps that an earlier run has taken.
  void begin_stage(long first_step);
  /// s of wall time since begin_stage().
  [[nodiscard]] double seconds() const;
  /// iterations: of the step.
  void after_step(const RunState& now, int iterations, const StageOutlook& outlook);

 private:
  using Clock = std::chrono::steady_clock;

  const RunSetup& setup_;
  double interval_;
  record::RunObserver& observer_;
  Clock::time_point begin_, last_report_;
  long first_step_ = 0, iterations_ = 0;  ///< of the stage
};

}  // namespace keyblock::simulation
