#include "dynamics/predicted_motion.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

std::pair<std::size_t, std::size_t> vertices_of(const contact::Surface& surface, std::size_t block) {
  return {at(surface.block_begin[block]), at(surface.block_begin[block + 1])};
}

}  // namespace

PredictedMotion::PredictedMotion(const Model& model)
    : reach_(model.blocks.size(), 0.0),
      turn_(model.blocks.size(), 0.0),
      path_(model.blocks.size(), 0.0),
      speed_(model.blocks.size(), 0.0),
      predicted_(model.surface.position.size()),
      differs_(model.blocks.size(), 0.0),
      is_far_(model.blocks.size(), 0) {}

void PredictedMotion::stay() {
  std::fill(reach_.begin(), reach_.end(), 0.0);
  std::fill(turn_.begin(), turn_.end(), 0.0);
}

void PredictedMotion::predict(const Model& model, const State& state, const Drive& drive, ThreadTeam& team) {
  predicted_at_first_.clear();
  const double acceleration = norm(model.gravity - drive.ground_acceleration) * drive.step * drive.step;
  for_moving_blocks(model, team, [&](std::size_t b) {
    const Block& block = model.blocks[b];
    // A static step has no velocity that says where blocks go: they may go twice as far as in the last one.
    if (drive.is_static) {
      reach_[b] = 2.0 * state.moved[b];
      turn_[b] = reach_[b] / block.radius;
      return;
    }
    const std::size_t first = at(model.surface.block_begin[b]);
    double fastest = 0.0, against_first = 0.0;
    for_vertex_values(
        model.surface, b, block.size, &state.velocity[block.first], [&](std::size_t v, Vec2 velocity) {
          predicted_[v] = drive.step * velocity;
          fastest = std::max(fastest, squared_norm(velocity));
          against_first = std::max(against_first, squared_norm(predicted_[v] - predicted_[first]));
        });
    speed_[b] = std::sqrt(fastest);
    differs_[b] = std::sqrt(against_first);
    // Twice as far as in free flight: neighbours push, and to look for contacts again costs more than a few candidates too many.
    reach_[b] = 2.0 * speed_[b] * drive.step + 2.0 * acceleration;
    const double spin = block.pose.mean_spin(&state.velocity[block.first], &state.position[block.first]);
    turn_[b] = std::min(2.0 * std::abs(spin) * drive.step, reach_[b] / block.radius);
  });
  for (const PrescribedMotion& motion : model.motions) {
    const std::size_t b = at(motion.block);
    const Vec2 moved = drive.prescribed[b];
    reach_[b] = norm(moved);
    const auto [begin, end] = vertices_of(model.surface, b);
    for (std::size_t v = begin; v < end; ++v) predicted_[v] = moved;
  }
}

bool PredictedMotion::is_exceeded(const Attempt& attempt, std::span<const double> spin,
                                  const contact::Tolerances& tolerances) {
  std::atomic<bool> any = false;
  const std::span<const Vec2> displacement = attempt.displacement;
  for_moving_blocks(attempt.model, attempt.team, [&](std::size_t b) {
    const Block& block = attempt.model.blocks[b];
    const auto [begin, end] = vertices_of(attempt.model.surface, b);
    double moved = 0.0;
    for (std::size_t v = begin; v < end; ++v) moved = std::max(moved, squared_norm(displacement[v]));
    moved = std::sqrt(moved);
    // Contacts are found as far as the activation distance beyond where two blocks come: a half of it is for each.
    const bool is_far = moved > reach_[b] + 0.5 * tolerances.activation,
               is_turned = std::abs(spin[b]) > turn_[b] + 0.5 * contact::Tolerances::sine_inside;
    if (is_far) reach_[b] = 1.5 * moved;
    if (is_turned) {
      turn_[b] = 1.5 * std::abs(spin[b]);
      reach_[b] = std::max(reach_[b], turn_[b] * block.radius);
    }
    is_far_[b] = is_far || is_turned;
    if (is_far_[b] != 0) any = true;
  });
  if (!any) return false;
  // A corner that an attempt held seems to go nowhere in the next: where it would go, the first prediction says.
  if (predicted_at_first_.empty()) predicted_at_first_ = predicted_;
  for_moving_blocks(attempt.model, attempt.team, [&](std::size_t b) {
    if (is_far_[b] == 0) return;
    const auto [begin, end] = vertices_of(attempt.model.surface, b);
    double against_first = 0.0;
    for (std::size_t v = begin; v < end; ++v) {
      predicted_[v] = displacement[v];
      against_first = std::max(against_first, squared_norm(displacement[v] - displacement[begin]));
    }
    differs_[b] = std::sqrt(against_first);
  });
  return true;
}

contact::StepMotion PredictedMotion::for_detection(std::span<const double> away, bool is_static) const {
  contact::StepMotion motion{reach_, turn_, away, path_};
  if (!is_static) {
    motion.predicted = predicted_;
    motion.predicted_path = differs_;
    motion.first_predicted = predicted_at_first_;
  }
  return motion;
}

}  // namespace keyblock::dynamics
