#include "coupling/mass_damping.h"

#include <algorithm>

#include "core/index.h"
#include "coupling/attempt.h"
#include "coupling/block_terms.h"
#include "model/drive.h"
#include "model/state_motion.h"
#include "model/turn.h"

namespace keyblock::dynamics {

/// On a block in a step: force − stiffness D, in its coefficients.
struct MassDamping::Drag {
  std::size_t block = 0;
  double viscosity = 0.0;  ///< α ρ
  double stiffness = 0.0;
  std::span<const MassPoint> points;  ///< of the block
  std::vector<double> force;          ///< of D = 0
};

namespace {

/// Adds the motion of the ground at the points of a block, averaged over the block, to its coefficients.
void average(std::span<const MassPoint> points, std::span<const Vec2> ground, std::vector<double>& of_block) {
  for (std::size_t k = 0; k < points.size() && !ground.empty(); ++k) {
    const Vec2 velocity = points[k].area * ground[k];
    for (std::size_t i = 0; 2 * i < of_block.size(); ++i) {
      of_block[2 * i] += points[k].point.phi[i] * velocity.x;
      of_block[2 * i + 1] += points[k].point.phi[i] * velocity.y;
    }
  }
}

/// The motion at the points of a block; empty where the ground is at rest.
std::span<const Vec2> of_points(std::span<const Vec2> ground, std::size_t first, std::size_t count) {
  return ground.empty() ? ground : ground.subspan(first, count);
}

}  // namespace

template <typename OfBlock>
void MassDamping::for_blocks(const Model& model, const State& state, const Drive& drive,
                             std::span<const Vec2> ground, const OfBlock& of_block) const {
  if (drive.is_static) return;
  Drag drag;
  for (std::size_t k = 0, end = 0; k < points_.size(); k = end) {
    const std::size_t b = at(points_[k].point.block);
    while (end < points_.size() && at(points_[end].point.block) == b) ++end;
    const Block& block = model.blocks[b];
    drag.points = std::span(points_).subspan(k, end - k);
    drag.force.assign(2 * at(block.size), 0.0);
    average(drag.points, of_points(ground, k, end - k), drag.force);
    if (!model.moves(b)) continue;
    const Integrator& rule = drive.rule[b];
    const double viscosity = rate_ * block.material.density;
    drag.block = b;
    drag.viscosity = viscosity;
    drag.stiffness = viscosity * rule.end_velocity_share() / drive.step;
    in_lanes(2 * block.size, [&](int first, int count) {
      const Lanes coasting =
          rule.end(motion_of(state, block.first + at(first), count), Lanes{}, drive.step).velocity;
      double* force = &drag.force[at(first)];
      store_first(force, viscosity * (load_first(force, count) - coasting), count);
    });
    of_block(drag);
  }
}

void MassDamping::add_terms(const Model& model, const State& state, const Drive& drive,
                            std::span<const Vec2> ground, BlockTerms& terms) const {
  for_blocks(model, state, drive, ground,
             [&](const Drag& drag) { terms.add_drag(drag.block, drag.stiffness, drag.force); });
}

void MassDamping::account(const Attempt& attempt, std::span<const double> spin, std::span<const Vec2> ground,
                          std::span<const Vec2> ground_before, State& state) const {
  EnergyLedger& ledger = state.ledger;
  std::vector<double> before;
  for_blocks(attempt.model, state, attempt.drive, ground, [&](const Drag& drag) {
    const std::size_t first = attempt.model.blocks[drag.block].first;
    const double* position = &state.position[first];
    double work = 0.0, not_stretched = 0.0;
    for (std::size_t k = 0; k < drag.force.size(); ++k) {
      const double d = attempt.increment[first + k], turned = turn_of(spin[drag.block], position, k);
      work += (drag.force[k] - drag.stiffness * d) * d;
      not_stretched += 0.5 * d * d + (d - 0.5 * turned) * turned;
    }
    const double of_start = 1.0 - attempt.drive.rule[drag.block].end_share_of_work();
    if (of_start > 0.0) {
      before.assign(drag.force.size(), 0.0);
      const std::size_t first_point = static_cast<std::size_t>(drag.points.data() - points_.data());
      average(drag.points, of_points(ground_before, first_point, drag.points.size()), before);
      double earlier = 0.0;
      for (std::size_t k = 0; k < before.size(); ++k) {
        const double d = attempt.increment[first + k];
        earlier +=
            of_start * d *
            (drag.viscosity * (before[k] - state.velocity[first + k]) - (drag.force[k] - drag.stiffness * d));
      }
      work += earlier;
      ledger.numerical += earlier;
    }
    ledger.damping -= work;
    // BlockTerms::elastic_loss has taken it for a spring.
    ledger.numerical -= drag.stiffness * not_stretched;
  });
}

}  // namespace keyblock::dynamics
