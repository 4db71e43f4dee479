#include "simulation/progress_meter.h"

#include <algorithm>

namespace keyblock::simulation {

void ProgressMeter::begin_stage(long first_step) {
  begin_ = last_report_ = Clock::now();
  first_step_ = first_step;
  iterations_ = 0;
}

double ProgressMeter::seconds() const {
  return std::chrono::duration<double>(Clock::now() - begin_).count();
}

void ProgressMeter::after_step(const RunState& now, int iterations, const StageOutlook& outlook) {
  iterations_ += iterations;
  const Clock::time_point time = Clock::now();
  const double since_last = std::chrono::duration<double>(time - last_report_).count();
  if (since_last < interval_ && outlook.steps_left > 0) return;
  last_report_ = time;
  const record::Stage& stage = setup_.stages[static_cast<std::size_t>(now.stage)];
  const bool is_static = stage.kind == record::StageKind::settle;
  record::Progress progress;
  progress.stage = now.stage;
  progress.stage_count = static_cast<int>(setup_.stages.size());
  progress.stage_name = stage.name;
  progress.kind = stage.kind;
  progress.step = now.stage_step;
  progress.fraction = outlook.fraction;
  progress.time = is_static ? 0.0 : static_cast<double>(now.stage_step) * setup_.time_step;
  const double elapsed = std::max(1e-9, seconds());
  const auto done = static_cast<double>(now.stage_step - first_step_);
  progress.steps_per_second = done / elapsed;
  progress.seconds_left =
      is_static ? -1.0 : static_cast<double>(outlook.steps_left) / progress.steps_per_second;
  progress.mean_iterations = static_cast<double>(iterations_) / done;
  progress.worst_residual_ratio = outlook.worst_ratio;
  observer_.progress(progress);
}

}  // namespace keyblock::simulation
