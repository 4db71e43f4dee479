#include "simulation/settle.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/index.h"
#include "coupling/coupling.h"
#include "record/verdict.h"

namespace keyblock::simulation {

namespace {
// The pseudo time step.
constexpr double longest_step_factor = 1e5;  // it grows up to this many time steps …
constexpr double quick_growth = 2.0;         // … by this factor after a step …
constexpr int quick_iterations = 16;         // … that takes no more than these …
constexpr double slow_growth = 1.5;          // … and by this one …
constexpr int most_iterations = 64;          // … up to these

// Creep: shares of the block size that a block may go in a static step.
constexpr double first_creep = 2e-4, most_creep = 1e-3, least_creep = 1e-6;
constexpr double held_creep = 1e-2;  // of a block on supports, which bends as far as its load demands
constexpr double too_long = 3.0;     // times the predicted balance, that steps leave when they are too long
constexpr double as_predicted = 1.5;
constexpr double wild = 0.3;  // predicted balance from which on nothing is learned of the length of steps
constexpr double inertia_falls = 0.25;  // of an inertia scale in a step, at most
constexpr double held_fast = 1e12;  // inertia of moving blocks over that of a block in a step of the scenario

// Equilibrium, and the trials for what moves.
constexpr int steps_to_hold = 2;
constexpr int first_trial = 8;  // steps of a stage before the first trial
constexpr int first_wait = 4,
              most_wait = 16;  // steps in which the predicted balance has not halved, before a trial
constexpr int walk = 24;       // steps that candidates get before the next trial
constexpr double trial_way =
    0.05;  // of the block size: way of the block most out of balance, if it were alone
constexpr double shorter = 1.0 / 3.0;  // pseudo time step of the second trial

// Static steps converge to a share of the balance that is asked for, as far as numbers have digits.
constexpr double step_share = 0.1, least_step_tolerance = 1e-9;
}  // namespace

Settler::Settler(const dynamics::Model& model, double time_step, double tolerance)
    : model_(model),
      longest_step_(longest_step_factor * time_step),
      tolerance_(tolerance),
      step_tolerance_(std::max(step_share * tolerance, least_step_tolerance)),
      is_held_(model.blocks.size(), false),
      moving_(model) {
  for (const int block : dynamics::held_blocks(model)) is_held_[at(block)] = true;
  memory_.time_step = time_step;
  memory_.creep = first_creep * model.block_size;
  memory_.best_predicted = HUGE_VAL;
  memory_.wait = first_wait;
  memory_.inertia_scale.assign(model.blocks.size(), 1.0);
}

Settler::Memory Settler::memory() {
  Memory memory = memory_;
  memory.blocks = moving_.memory();
  return memory;
}

void Settler::restore(Memory memory) {
  moving_.memory() = std::move(memory.blocks);
  memory_ = std::move(memory);
  memory_.blocks = {};
}

void Settler::begin_again() {
  memory_.quiet_steps = 0;
  memory_.creep = first_creep * model_.block_size;
  memory_.best_predicted = HUGE_VAL;
  memory_.since_best = 0;
  memory_.wait = first_wait;
}

double Settler::held_scale(double step) const {
  const double longer = step * longest_step_factor / longest_step_;
  return held_fast * longer * longer;
}

/// Steps that are not kept unless they turn out to be good ones: with so little inertia that the block most out of balance goes far if
/// nothing holds it. True when the step is taken.
bool Settler::try_far(dynamics::Stepper& stepper, dynamics::State& state, dynamics::StepReport& report) {
  const double theta = 1.0 + model_.solver.theta,
               step = std::sqrt(theta * trial_way * model_.block_size / memory_.trial_acceleration);
  std::vector<double> scale(model_.blocks.size(), 1.0);
  for (std::size_t b = 0; b < scale.size(); ++b) {
    if (moving_.moves(b)) scale[b] = held_scale(step);
  }
  dynamics::StaticStep trial{.step = step,
                             .inertia_scale = scale,
                             .tolerance = step_tolerance_,
                             .is_trial = true,
                             .farthest = most_creep * model_.block_size};
  report = stepper.relax(state, trial);
  memory_.since_best = 0;
  if (report.taken) return true;
  memory_.wait = std::min(2 * memory_.wait, most_wait);
  if (!report.converged) return false;
  const std::vector<double> ways(stepper.travel().begin(), stepper.travel().end());
  const int iterations = report.iterations;
  const double first = report.shortest;
  trial.step = shorter * first;
  trial.farthest = -1.0;
  report = stepper.relax(state, trial);
  report.iterations += iterations;
  const double ratio = first * first / (report.shortest * report.shortest);
  if (report.converged && moving_.suspect({ways, stepper.travel(), ratio}, stepper.contacts()))
    memory_.since_best = first_wait - walk;
  return false;
}

bool Settler::step(dynamics::Stepper& stepper, dynamics::State& state, dynamics::StepReport& report) {
  const bool stalls = memory_.steps >= first_trial && memory_.since_best >= memory_.wait &&
                      memory_.best_predicted > tolerance_ && memory_.trial_acceleration > 0.0;
  int tried = 0;
  if (!stalls || !try_far(stepper, state, report)) {
    tried = stalls ? report.iterations : 0;
    report = stepper.relax(state, {.step = memory_.time_step,
                                   .inertia_scale = memory_.inertia_scale,
                                   .tolerance = step_tolerance_,
                                   .settles_bounds = memory_.best_predicted <= tolerance_});
  }
  const dynamics::ForceBalance& balance = stepper.balance();
  const bool news = moving_.go(balance, stepper.travel(), tolerance_);
  memory_.worst_ratio = 0.0;
  double worst_predicted = 0.0;
  bool all_balance = report.converged && balance.left_of_lines() <= tolerance_;
  const auto counts = [&](std::size_t b) { return model_.moves(b) && !moving_.moves(b); };
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!counts(b)) continue;
    memory_.worst_ratio = std::max(memory_.worst_ratio, balance[b].ratio);
    all_balance = all_balance && balance.balances(b, tolerance_);
    worst_predicted = std::max(worst_predicted, balance[b].predicted);
  }
  memory_.trial_acceleration = balance.largest_acceleration(counts);
  ++memory_.steps;
  control(report, worst_predicted);
  control_inertia(stepper.travel());
  memory_.worst_ratio = std::max(memory_.worst_ratio, balance.left_of_lines());
  if (news) begin_again();
  report.iterations += tried;
  memory_.quiet_steps = all_balance ? memory_.quiet_steps + 1 : 0;
  return memory_.quiet_steps >= steps_to_hold;
}

/// Pseudo time step and creep limit of the next step, and whether the balance gets better.
void Settler::control(const dynamics::StepReport& report, double worst_predicted) {
  if (memory_.first_ratio == 0.0) memory_.first_ratio = memory_.worst_ratio;
  if (report.substeps > 1) {
    memory_.time_step = std::min(memory_.time_step, report.shortest);
  } else if (report.converged) {
    const double growth = report.iterations <= quick_iterations  ? quick_growth
                          : report.iterations <= most_iterations ? slow_growth
                                                                 : 1.0;
    memory_.time_step = std::min(growth * memory_.time_step, longest_step_);
  }
  if (memory_.worst_ratio > too_long * worst_predicted + tolerance_ && worst_predicted < wild) {
    memory_.creep = std::max(0.25 * memory_.creep, least_creep * model_.block_size);
  } else if (memory_.worst_ratio < as_predicted * worst_predicted + tolerance_) {
    memory_.creep = std::min(2.0 * memory_.creep, most_creep * model_.block_size);
  }
  ++memory_.since_best;
  if (worst_predicted < 0.5 * memory_.best_predicted) {
    memory_.best_predicted = worst_predicted;
    memory_.since_best = std::min(memory_.since_best, 0);
  }
}

void Settler::control_inertia(std::span<const double> moved) {
  const double farthest = most_creep * model_.block_size, held = held_creep * model_.block_size;
  for (std::size_t b = 0; b < model_.blocks.size(); ++b) {
    if (!model_.moves(b)) continue;
    double& scale = memory_.inertia_scale[b];
    if (moving_.moves(b)) {
      scale = held_scale(memory_.time_step);
      continue;
    }
    const double limit = is_held_[b] ? held : moving_.is_candidate(b) ? farthest : memory_.creep;
    scale = std::max(1.0, scale * std::clamp(moved[b] / limit, inertia_falls, 1e6));
  }
}

std::vector<bool> Settler::which_move() const {
  std::vector<bool> moving(model_.blocks.size());
  for (std::size_t b = 0; b < moving.size(); ++b) moving[b] = model_.moves(b) && moving_.moves(b);
  return moving;
}

std::vector<record::MovingBlock> Settler::moving(const dynamics::Stepper& stepper) const {
  std::vector<int> group(model_.blocks.size());  // of a block: the least of its blocks
  std::iota(group.begin(), group.end(), 0);
  const auto leader = [&](int b) {
    while (group[at(b)] != b) b = group[at(b)];
    return b;
  };
  const auto joins = [&](int b) {
    return moving_.moves(at(b)) && !record::is_falling(moving_.carried(at(b)));
  };
  for (const contact::Contact& contact : stepper.contacts()) {
    if (!joins(contact.block_a) || !joins(contact.block_b)) continue;
    const int one = leader(contact.block_a), other = leader(contact.block_b);
    group[at(std::max(one, other))] = std::min(one, other);
  }
  std::vector<record::MovingBlock> blocks;
  for (int b = 0; b < static_cast<int>(model_.blocks.size()); ++b) {
    if (model_.moves(at(b)) && moving_.moves(at(b))) blocks.push_back({b, moving_.carried(at(b)), leader(b)});
  }
  return blocks;
}

double Settler::progress() const {
  if (memory_.worst_ratio <= tolerance_) return 1.0;
  if (memory_.first_ratio <= tolerance_) return 0.0;
  return std::clamp(
      std::log(memory_.first_ratio / memory_.worst_ratio) / std::log(memory_.first_ratio / tolerance_), 0.0,
      1.0);
}

}  // namespace keyblock::simulation
