#include "simulation/stage_motion.h"

#include <algorithm>

#include "loading/motion_measures.h"
#include "simulation/step_count.h"

namespace keyblock::simulation {
namespace {

constexpr std::size_t motion_points = 4000;  // of the applied motion kept for plots

}  // namespace

void plan_motion(const RunSetup& setup, record::StageRecord& record) {
  const record::Stage& stage = record.stage;
  if (stage.kind == record::StageKind::settle) return;
  double duration = stage.duration.value_or(0.0);
  if (stage.kind == record::StageKind::shake) {
    const loading::GroundMotion& ground = setup.motions.at(static_cast<std::size_t>(stage.motion));
    if (!stage.duration) duration = ground.duration();
    const loading::ShakingMeasures shaking = loading::measure(ground, stage.scale, duration);
    record.pga = shaking.peak;
    record.pgv = shaking.peak_velocity;
    record.arias = shaking.arias_intensity;
    const std::size_t every_nth = std::max<std::size_t>(1, ground.times().size() / motion_points);
    for (std::size_t k = 0; k < ground.times().size(); k += every_nth) {
      record.motion_time.push_back(ground.times()[k]);
      record.motion.push_back(stage.scale * ground.accelerations()[k]);
    }
  }
  record.planned_duration = step_count(duration, setup.time_step) * setup.time_step;
}

}  // namespace keyblock::simulation
