// The part of a step that concerns fixed blocks with a prescribed motion.
#include <cmath>

#include "dynamics/step.h"

namespace keyblock::dynamics {

/// What the step moves fixed blocks by: the way from where they are to where they are to be at its end.
void Stepper::prescribe(const State& state, Drive& drive) {
  for (const PrescribedMotion& motion : model_.motions) {
    const auto b = static_cast<std::size_t>(motion.block);
    const Block& block = model_.blocks[b];
    const Vec2 now =
        Vec2{state.position[block.first], state.position[block.first + 1]} / std::sqrt(block.area);
    prescribed_[b] = motion.centroid(drive.end_time) - now;
  }
  drive.prescribed = prescribed_;
}

/// Takes the motion of the step over into the state.
void Stepper::move_prescribed(State& state, const Drive& drive) {
  for (const PrescribedMotion& motion : model_.motions) {
    const auto b = static_cast<std::size_t>(motion.block);
    const Block& block = model_.blocks[b];
    const Vec2 moved = std::sqrt(block.area) * prescribed_[b];
    const double rate = drive.is_static ? 0.0 : 1.0 / drive.step;
    state.position[block.first] += moved.x;
    state.position[block.first + 1] += moved.y;
    state.velocity[block.first] = rate * moved.x;
    state.velocity[block.first + 1] = rate * moved.y;
  }
}

}  // namespace keyblock::dynamics
