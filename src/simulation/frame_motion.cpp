#include "simulation/frame_motion.h"

#include "core/index.h"

namespace keyblock::simulation {

namespace {

/// Moves on by a time in a stage, s.
void go_on(const RunSetup& setup, const record::Stage& stage, double time, dynamics::GroundMove& frame) {
  if (stage.kind == record::StageKind::settle) {
    frame.velocity = {};
    return;
  }
  frame.displacement += time * frame.velocity;
  if (stage.kind != record::StageKind::shake) return;
  const loading::GroundMotion& motion = setup.motions.at(at(stage.motion));
  frame.displacement += stage.scale * motion.displacement(time);
  frame.velocity += stage.scale * motion.velocity(time);
}

}  // namespace

dynamics::GroundMove frame_motion(const RunSetup& setup, const RunState& now) {
  dynamics::GroundMove frame;
  for (const record::StageRecord& ended : now.record.stages) go_on(setup, ended.stage, ended.duration, frame);
  if (at(now.stage) < setup.stages.size() && now.record.stages.size() == at(now.stage))
    go_on(setup, setup.stages[at(now.stage)], now.mechanics.time - now.stage_start, frame);
  return frame;
}

}  // namespace keyblock::simulation
