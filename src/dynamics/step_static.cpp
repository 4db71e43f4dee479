// Static steps, and the balance of forces at the position that they reach.
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "dynamics/step.h"
#include "solve/step_matrix.h"
#include "solve/step_numbers.h"

namespace keyblock::dynamics {

namespace {

/// Shear forces of a static step belong to its own normal forces, to as many digits as its end is measured by.
SolverOptions options_of(const StaticStep& step, SolverOptions options) {
  using namespace step_numbers;
  double bound_error = std::clamp(static_bound_share * step.tolerance, least_bound_error, most_bound_error);
  if (step.settles_bounds) bound_error = std::max(settled_bound_share * bound_error, least_bound_error);
  options.bound_tolerance = std::min(options.bound_tolerance, bound_error);
  options.bound_accuracy = std::min(options.bound_accuracy, bound_error);
  if (step.settles_bounds)
    options.max_bound_updates = std::max(options.max_bound_updates, most_static_bound_updates);
  options.tolerance = std::min(options.tolerance, step.tolerance);
  if (step.is_trial) options.max_halvings = std::min(options.max_halvings, 1);
  return options;
}

/// m, per block: how far its vertices go.
void find_travel(const Model& model, std::span<const Vec2> displacement, std::span<double> travel) {
  for (std::size_t b = 0; b < travel.size(); ++b) {
    double squared = 0.0;
    if (model.moves(b)) {
      for (std::size_t v = at(model.surface.block_begin[b]); v < at(model.surface.block_begin[b + 1]); ++v)
        squared = std::max(squared, squared_norm(displacement[v]));
    }
    travel[b] = std::sqrt(squared);
  }
}

/// σ over E/(ρA): far above rounding, far below what a block that buckles lacks.
constexpr double least_shift = 1e-9;
constexpr double more_shift = 10.0, most_shift = 1e3;  // until the matrix is positive definite
constexpr double held_fast = 1e12;                     // times σ, of what is left out
constexpr int mode_iterations = 30;
constexpr std::size_t most_unknowns =
    200'000;  // of a matrix that is factored whole, whatever solver the steps take

/// Every contact that presses sticks.
void hold_along_joints(SpringArray& springs) {
  for (std::size_t c = 0; c < springs.size(); ++c) {
    SpringArray::Branch branch = springs.branch[c];
    if (springs.friction[c] < 0.0 || !(springs.bearing(c) > 0.0)) continue;
    branch.shear = SpringArray::Shear::held;
    springs.set_branch(c, branch);
  }
}

/// Of the lowest mode of a matrix that has a factor.
int farthest_block(const Model& model, linalg::BlockSolver& solver) {
  std::vector<double> mode(model.unknowns), residual(model.unknowns);
  for (std::size_t k = 0; k < mode.size(); ++k) mode[k] = 1.0 / static_cast<double>(1 + k % 7);
  for (int i = 0; i < mode_iterations; ++i) {
    std::fill(residual.begin(), residual.end(), 0.0);
    solver.solve(mode, residual, [](std::span<const double>) { return 0.0; });
    const double largest =
        std::abs(*std::ranges::max_element(mode, {}, [](double x) { return std::abs(x); }));
    for (double& x : mode) x /= std::max(largest, 1e-300);
  }
  int farthest = -1;
  double most = 0.0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!model.moves(b)) continue;
    double squared = 0.0;
    for (std::size_t k = 0; k < 2 * at(model.blocks[b].size); ++k)
      squared += mode[model.blocks[b].first + k] * mode[model.blocks[b].first + k];
    if (squared <= most) continue;
    most = squared;
    farthest = static_cast<int>(b);
  }
  return farthest;
}

}  // namespace

/// A static step of length 1.
Drive Stepper::static_drive(const State& state, std::span<const double> inertia_scale) const {
  Drive drive;
  drive.end_time = state.time;
  drive.is_static = true;
  drive.wears_joints = model_.joints_wear;
  drive.ground_acceleration = model_.static_ground;
  drive.step = 1.0;
  drive.inertia_scale = inertia_scale;
  return drive;
}

int Stepper::find_unstable_block(State& state, const std::vector<bool>& left_out) {
  if (model_.unknowns > most_unknowns) return -1;
  std::vector<double> scale(model_.blocks.size());
  Drive drive = static_drive(state, scale);
  drive.rule = rules_.rule();
  drive.prescribed = prescribed_;
  StepMatrix matrix;
  for (double shift = least_shift; shift <= most_shift; shift *= more_shift) {
    for (std::size_t b = 0; b < scale.size(); ++b) {
      const Block& block = model_.blocks[b];
      scale[b] = shift * block.material.young / (block.material.density * block.area) *
                 (left_out[b] ? held_fast : 1.0);
    }
    build(state, drive, true);
    hold_along_joints(problem_.springs());
    linalg::BlockSolver& solver = choose_solver(state, true, true);
    open_close_.forget_factor();
    matrix.assemble({problem_, finder_.of_step(), solver, model_.solver, team_, profile_});
    if (!solver.factor()) continue;
    return shift == least_shift ? -1 : farthest_block(model_, solver);
  }
  return -1;
}

StepReport Stepper::relax(State& state, const StaticStep& static_step) {
  StepReport report;
  history_.forget();
  const SolverOptions options = options_of(static_step, model_.solver);
  Drive drive = static_drive(state, static_step.inertia_scale);
  drive.is_trial = static_step.is_trial;
  drive.step = static_step.step;
  for (;; drive.step *= 0.5) {
    report.converged = attempt(state, drive, options, report) &&
                       (drive.is_trial || !comes_inside(solution(state, drive), rotation_, intrusions_));
    if (report.converged || report.halvings >= options.max_halvings + step_numbers::more_static_halvings)
      break;
    report.substeps += 1;
    report.halvings += 1;
  }
  report.shortest = drive.step;
  find_travel(model_, open_close_.displacement(), travel_);
  report.taken =
      !static_step.is_trial ||
      (report.converged && *std::max_element(travel_.begin(), travel_.end()) <= static_step.farthest);
  if (!report.taken) return report;
  balance_.predict(model_, problem_, increment_);
  accept(state, drive, report);
  ++state.step;
  find_forces(state);
  balance_.measure(model_, problem_);
  return report;
}

/// Contacts are those that the next static step would begin with.
const StepProblem& Stepper::find_forces(State& state) {
  const std::vector<double> scale(model_.blocks.size(), 1.0);
  Drive drive = static_drive(state, scale);
  predict(state, drive);
  find(state, drive);
  build(state, drive, false);
  ForceBalance::take_bounds(problem_);
  return problem_;
}

}  // namespace keyblock::dynamics
