// Static steps, and the balance of forces at the position that they reach.
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "dynamics/step.h"
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

}  // namespace

StepReport Stepper::relax(State& state, const StaticStep& static_step) {
  StepReport report;
  history_.forget();
  const SolverOptions options = options_of(static_step, model_.solver);
  Drive drive;
  drive.end_time = state.time;
  drive.is_static = true;
  drive.is_trial = static_step.is_trial;
  drive.inertia_scale = static_step.inertia_scale;
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
  Drive drive;
  drive.end_time = state.time;
  drive.is_static = true;
  drive.step = 1.0;
  const std::vector<double> scale(model_.blocks.size(), 1.0);
  drive.inertia_scale = scale;
  predict(state, drive);
  find(state, drive);
  build(state, drive, false);
  ForceBalance::take_bounds(problem_);
  return problem_;
}

}  // namespace keyblock::dynamics
