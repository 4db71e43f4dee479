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
  double stiffness = 0.0;
  std::vector<double> force;  ///< of D = 0
};

template <typename OfBlock>
void MassDamping::for_blocks(const Model& model, const State& state, const Drive& drive,
                             std::span<const Vec2> ground, const OfBlock& of_block) const {
  if (drive.is_static) return;
  Drag drag;
  for (std::size_t k = 0; k < points_.size();) {
    const std::size_t b = at(points_[k].point.block);
    const auto is_of_block = [&](std::size_t point) {
      return point < points_.size() && at(points_[point].point.block) == b;
    };
    const Block& block = model.blocks[b];
    drag.force.assign(2 * at(block.size), 0.0);
    for (; is_of_block(k); ++k) {
      if (ground.empty()) continue;
      const Vec2 velocity = points_[k].area * ground[k];
      for (std::size_t i = 0; i < at(block.size); ++i) {
        drag.force[2 * i] += points_[k].point.phi[i] * velocity.x;
        drag.force[2 * i + 1] += points_[k].point.phi[i] * velocity.y;
      }
    }
    if (!model.moves(b)) continue;
    const Integrator& rule = drive.rule[b];
    const double viscosity = rate_ * block.material.density;
    drag.block = b;
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
                          State& state) const {
  EnergyLedger& ledger = state.ledger;
  for_blocks(attempt.model, state, attempt.drive, ground, [&](const Drag& drag) {
    const std::size_t first = attempt.model.blocks[drag.block].first;
    const double* position = &state.position[first];
    double work = 0.0, not_stretched = 0.0;
    for (std::size_t k = 0; k < drag.force.size(); ++k) {
      const double d = attempt.increment[first + k], turned = turn_of(spin[drag.block], position, k);
      work += (drag.force[k] - drag.stiffness * d) * d;
      not_stretched += 0.5 * d * d + (d - 0.5 * turned) * turned;
    }
    ledger.damping -= work;
    // BlockTerms::elastic_loss has taken it for a spring.
    ledger.numerical -= drag.stiffness * not_stretched;
  });
}

}  // namespace keyblock::dynamics
