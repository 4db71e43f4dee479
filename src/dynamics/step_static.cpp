// Static steps, and the balance of forces at the position that they reach.
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "dynamics/step.h"

namespace keyblock::dynamics {

namespace {

/// Shear forces of a static step belong to its own normal forces, to as many digits as its end is measured by: bounds that lag by 1 % of
/// all forces would leave a thousandth of the weight of single blocks out of balance, step after step.
constexpr double most_bound_error = 1e-7, least_bound_error = 1e-12, bound_share = 1e-2;
/// The error of bounds is that of all contacts together, and may be that of one small block. Where bounds alone are left to be found, it
/// has to be so much less.
constexpr double settled_share = 1e-4;
constexpr int most_bound_updates = 40;

SolverOptions options_of(const StaticStep& step, SolverOptions options) {
  double bound_error = std::clamp(bound_share * step.tolerance, least_bound_error, most_bound_error);
  if (step.settles_bounds) bound_error = std::max(settled_share * bound_error, least_bound_error);
  options.bound_tolerance = std::min(options.bound_tolerance, bound_error);
  options.bound_accuracy = std::min(options.bound_accuracy, bound_error);
  if (step.settles_bounds)
    options.max_bound_updates = std::max(options.max_bound_updates, most_bound_updates);
  options.tolerance = std::min(options.tolerance, step.tolerance);
  if (step.is_trial) options.max_halvings = std::min(options.max_halvings, 1);
  return options;
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
  // Pseudo time may have grown to many times what a block needs to pass through another one.
  constexpr int more_halvings = 14;
  for (;; drive.step *= 0.5) {
    report.converged = attempt(state, drive, options, report) && (drive.is_trial || !comes_inside(state));
    if (report.converged || report.halvings >= options.max_halvings + more_halvings) break;
    report.substeps += 1;
    report.halvings += 1;
  }
  report.shortest = drive.step;
  find_ways();
  report.taken = !static_step.is_trial ||
                 (report.converged &&
                  *std::max_element(static_ways_.begin(), static_ways_.end()) <= static_step.farthest);
  if (!report.taken) return report;
  balance_.predict(model_, problem_, increment_);
  accept(state, drive, report);
  ++state.step;
  measure_balance(state);
  return report;
}

void Stepper::find_ways() {
  const std::span<const Vec2> went = open_close_.displacement();
  for (std::size_t b = 0; b < static_ways_.size(); ++b) {
    double squared = 0.0;
    if (model_.moves(b)) {
      for (std::size_t v = at(model_.surface.block_begin[b]); v < at(model_.surface.block_begin[b + 1]); ++v)
        squared = std::max(squared, squared_norm(went[v]));
    }
    static_ways_[b] = std::sqrt(squared);
  }
}

/// Contacts are those that the next static step would begin with.
void Stepper::measure_balance(State& state) {
  Drive drive;
  drive.end_time = state.time;
  drive.is_static = true;
  drive.step = 1.0;
  const std::vector<double> scale(model_.blocks.size(), 1.0);
  drive.inertia_scale = scale;
  choose_rules(state, drive);
  drive.rule = rule_;
  prescribe(state, drive);
  predict_reach(state, drive);
  turned_.clear();
  earlier_attempt_.forget();
  detect(state, true);
  build_problem(state, drive, false);
  balance_.measure(model_, problem_);
}

}  // namespace keyblock::dynamics
