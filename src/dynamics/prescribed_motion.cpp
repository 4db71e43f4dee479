#include "dynamics/prescribed_motion.h"

#include <cmath>

#include "core/index.h"

namespace keyblock::dynamics {

void prescribe(const Model& model, const State& state, double end_time, std::span<Vec2> prescribed) {
  for (const PrescribedMotion& motion : model.motions) {
    const Block& block = model.blocks[at(motion.block)];
    const Vec2 now =
        Vec2{state.position[block.first], state.position[block.first + 1]} / std::sqrt(block.area);
    prescribed[at(motion.block)] = motion.centroid(end_time) - now;
  }
}

void move_prescribed(const Model& model, const Drive& drive, State& state) {
  for (const PrescribedMotion& motion : model.motions) {
    const Block& block = model.blocks[at(motion.block)];
    const Vec2 moved = std::sqrt(block.area) * drive.prescribed[at(motion.block)];
    const double rate = drive.is_static ? 0.0 : 1.0 / drive.step;
    state.position[block.first] += moved.x;
    state.position[block.first + 1] += moved.y;
    state.velocity[block.first] = rate * moved.x;
    state.velocity[block.first + 1] = rate * moved.y;
  }
}

}  // namespace keyblock::dynamics
