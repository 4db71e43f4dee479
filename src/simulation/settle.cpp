#include "simulation/settle.h"

#include <algorithm>
#include <cmath>

namespace keyblock::simulation {

namespace {
constexpr double longest_step_factor = 50.0;  // pseudo time steps grow up to this many time steps
constexpr double creep_share = 2e-4;  // of the block size: largest displacement of a block in a static step
constexpr double held_creep_share =
    1e-2;  // the same of a block on supports, which bends as far as its load demands
constexpr double travel_share = 0.02;  // of the block size: creep beyond which a block is called moving
constexpr double nearer =
    0.9;  // of the best balance of a block so far: one that comes to that is on its way to equilibrium
constexpr int steps_to_hold = 5;     // equilibrium has to last this many steps
constexpr int quick_iterations = 8;  // a step that takes no more lets the pseudo time step grow
}  // namespace

Settler::Settler(const dynamics::Model& model, double time_step, double tolerance)
    : model_(model),
      longest_step_(longest_step_factor * time_step),
      tolerance_(tolerance),
      creep_limit_(model.blocks.size(), creep_share * model.block_size),
      travel_limit_(model.blocks.size(), travel_share * model.block_size) {
  for (const dynamics::GroundSpring& spring : model.springs) {
    const auto held = static_cast<std::size_t>(spring.block);
    creep_limit_[held] = held_creep_share * model.block_size;
    travel_limit_[held] = HUGE_VAL;
  }
  memory_.time_step = time_step;
  memory_.inertia_scale.assign(model.blocks.size(), 1.0);
  memory_.travel.assign(model.blocks.size(), 0.0);
  memory_.nearest.assign(model.blocks.size(), HUGE_VAL);
  memory_.carried.assign(model.blocks.size(), 1.0);
}

bool Settler::step(dynamics::Stepper& stepper, dynamics::State& state, dynamics::StepReport& report) {
  report = stepper.relax(state, memory_.time_step, memory_.inertia_scale);
  worst_ratio_ = 0.0;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    const dynamics::Stepper::Balance balance = stepper.balance()[b];
    const double moved = state.moved[b];
    double& scale = memory_.inertia_scale[b];
    scale = std::max(1.0, scale * std::clamp(moved / creep_limit_[b], 0.5, 1e6));
    const bool balances = balance.ratio <= tolerance_;
    if (balances || balance.ratio <= nearer * memory_.nearest[b]) {
      memory_.nearest[b] = balances ? HUGE_VAL : balance.ratio;
      memory_.travel[b] = 0.0;
    } else {
      memory_.travel[b] += moved;
    }
    memory_.carried[b] = 1.0 - balance.falling;
    if (memory_.travel[b] <= travel_limit_[b]) worst_ratio_ = std::max(worst_ratio_, balance.ratio);
  }
  if (memory_.first_ratio == 0.0) memory_.first_ratio = worst_ratio_;
  if (report.converged && report.substeps == 1 && report.iterations <= quick_iterations) {
    memory_.time_step = std::min(1.25 * memory_.time_step, longest_step_);
  } else if (report.substeps > 1) {
    memory_.time_step *= 0.5;
  }
  memory_.quiet_steps = report.converged && worst_ratio_ <= tolerance_ ? memory_.quiet_steps + 1 : 0;
  return memory_.quiet_steps >= steps_to_hold;
}

std::vector<MovingBlock> Settler::moving() const {
  std::vector<MovingBlock> blocks;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (model_.moves(b) && memory_.travel[b] > travel_limit_[b]) {
      blocks.push_back({static_cast<int>(b), std::clamp(memory_.carried[b], 0.0, 1.0)});
    }
  }
  return blocks;
}

double Settler::progress() const {
  if (worst_ratio_ <= tolerance_) return 1.0;
  if (memory_.first_ratio <= tolerance_) return 0.0;
  return std::clamp(std::log(memory_.first_ratio / worst_ratio_) / std::log(memory_.first_ratio / tolerance_),
                    0.0, 1.0);
}

}  // namespace keyblock::simulation
