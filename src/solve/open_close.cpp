#include "solve/open_close.h"

#include <algorithm>

#include "solve/step_numbers.h"

namespace keyblock::dynamics {

/// Forgets what was known within the last step.
void OpenClose::begin(const StepSystem& system, std::span<double> d) {
  iterate_.begin(system, d);
  laws_.begin();
  newton_.begin(system);
  bond_updates_ = misses_ = 0;
  const bool is_kept = kept_.begin_step(system, matrix_, update_);
  // Without halves the matrix of an earlier step is brought to this one; with them its factor is used as it is.
  matrix_.begin_step(is_kept && system.solver.low_rank() == nullptr);
}

/// Whether what is solved is the matrix of this step, to all the digits that are asked for.
bool OpenClose::is_exact(const StepSystem& system) const {
  const linalg::LowRankSolver* halves = system.solver.low_rank();
  return !kept_.is_kept() && (halves == nullptr || halves->is_exact());
}

/// Within a step only what changed is assembled and factored anew.
bool OpenClose::factor(const StepSystem& system) {
  {
    const Profile::Scope scope(system.profile, Phase::assembly);
    if (!matrix_.is_assembled()) {
      kept_.note(system);
      matrix_.assemble(system);
    } else if (!matrix_.update(system)) {
      return true;
    }
  }
  update_.reset();
  const Profile::Scope scope(system.profile, Phase::factorization);
  return system.solver.factor();
}

/// From D along a Newton direction to the minimum. False when the linear system has no solution.
bool OpenClose::newton_step(const StepSystem& system, double enough, OpenCloseResult& result) {
  ++result.iterations;
  if (!factor(system)) return false;
  const bool was_exact = is_exact(system);
  if (!newton_.solve(system, iterate_, was_exact, result)) return false;
  if (was_exact != is_exact(system)) update_.reset();  // it is of another factor
  return newton_.go_along(system, iterate_, enough, is_exact(system), result);
}

/// Whether the balance that a Newton step came to is true. The gradient itself shows what the matrix of an earlier step, or one of few digits,
/// got wrong. Where that is too much, another Newton step takes it off, and the matrix of the next time step is its own.
bool OpenClose::settles(const StepSystem& system, double enough, OpenCloseResult& result) {
  if (is_exact(system)) return true;
  iterate_.place(system);
  iterate_.find_gradient(system);
  if (iterate_.out_of_balance(system) < enough) return true;
  if (kept_.is_kept()) kept_.drop();
  ++result.refinements;
  if (misses_++ > 0) {
    kept_.forget();
    matrix_.forget();
  }
  return false;
}

/// At the beginning of a step: the factor that low-rank updates need, and the gradient where D is not 0, at which springs are built.
OpenClose::Minimum OpenClose::begin_minimum(const StepSystem& system, bool warm, bool updates,
                                            bool& from_zero) {
  if (warm) return Minimum::not_found;
  from_zero = updates && std::ranges::all_of(iterate_.increment, [](double v) { return v == 0.0; });
  if (updates && !kept_.is_kept() && !factor(system)) return Minimum::failed;
  if (from_zero) return Minimum::not_found;
  iterate_.place(system);
  iterate_.find_gradient(system);
  const double enough = step_numbers::linear_share * system.options.tolerance;
  return !updates && iterate_.out_of_balance(system) <= enough ? Minimum::found : Minimum::not_found;
}

/// The first update has the springs of the last step; later it is worth trying where few springs differ from the matrix. With a kept
/// factor that does not do, the next one has a factor of this step.
OpenClose::Minimum OpenClose::update(const StepSystem& system, int& tries, bool& from_zero,
                                     OpenCloseResult& result) {
  const bool is_worth_it =
      tries > 0 && (result.iterations == 0 ||
                    matrix_.count_differing(system.springs()) <= LowRankUpdate::limit(system) / 3);
  if (!is_worth_it) return Minimum::not_found;
  if (update_.minimize(system, iterate_, matrix_, kept_.is_kept(), std::exchange(from_zero, false), result) &&
      iterate_.out_of_balance(system) < system.options.tolerance)
    return Minimum::found;
  if (kept_.is_kept()) return factor(system) ? Minimum::tried_kept_factor : Minimum::failed;
  --tries;
  return Minimum::not_found;
}

/// With a low-rank update where the solver can do so, and Newton's method where too many springs act otherwise.
bool OpenClose::minimize(const StepSystem& system, bool warm, double enough, OpenCloseResult& result) {
  const int limit = result.iterations + system.options.max_iterations;
  const bool updates = system.updates_by_low_rank();
  bool from_zero = false;
  Minimum minimum = begin_minimum(system, warm, updates, from_zero);
  for (int tries = updates ? step_numbers::most_tries : 0;
       minimum != Minimum::found && minimum != Minimum::failed && result.iterations < limit;) {
    look_at_stop();
    minimum = update(system, tries, from_zero, result);
    if (minimum == Minimum::not_found) minimum = newton(system, enough, result);
  }
  return minimum == Minimum::found;
}

/// One step of Newton's method. A kept factor that it fails with is forgotten.
OpenClose::Minimum OpenClose::newton(const StepSystem& system, double enough, OpenCloseResult& result) {
  if (!newton_step(system, enough, result)) {
    if (!kept_.is_kept()) return Minimum::failed;
    kept_.forget();
    matrix_.forget();
    return Minimum::not_found;
  }
  const bool is_found = iterate_.out_of_balance(system) < enough && settles(system, enough, result);
  return is_found ? Minimum::found : Minimum::not_found;
}

/// What the solution does to the laws of springs, except to bounds of friction: whether Π has to be minimized again.
bool OpenClose::change_laws(const StepSystem& system, OpenCloseResult& result) {
  const SolverOptions& options = system.options;
  if (laws_.reverse_sliding(system, iterate_, options.bound_tolerance)) return true;
  if (bond_updates_ < step_numbers::most_bond_updates && laws_.renew_bonds(system, iterate_)) {
    ++bond_updates_;
    return true;
  }
  if (laws_.break_bonds(system, iterate_)) {
    result.bond_broken = true;
    return true;
  }
  return laws_.change_couplings(system, iterate_);
}

OpenCloseResult OpenClose::solve(const StepSystem& system, std::span<double> d,
                                 const std::function<bool()>& gives_up) {
  const SolverOptions& options = system.options;
  const Profile::Scope scope(system.profile, Phase::search);
  SpringArray& springs = system.springs();
  look_at_stop();
  begin(system, d);
  OpenCloseResult result;
  double enough = options.tolerance;
  for (bool warm = false;; warm = true) {
    result.converged = minimize(system, warm, enough, result);
    if (!result.converged) {
      result.linear_failed = !system.solver.solved();
      break;
    }
    if (change_laws(system, result)) continue;
    const double tolerance = springs.bounds_updated ? options.bound_accuracy : options.bound_tolerance;
    if (result.bound_updates < options.max_bound_updates &&
        laws_.update_bounds(system, iterate_, tolerance)) {
      springs.bounds_updated = true;
      result.given_up = ++result.bound_updates == 1 && gives_up && gives_up();
      if (result.given_up) break;
      enough = std::max(options.tolerance, step_numbers::rough_share * iterate_.out_of_balance(system));
      continue;
    }
    if (iterate_.out_of_balance(system) < options.tolerance) break;
    enough = options.tolerance;
  }
  iterate_.place_if_moved(system);
  result.finite = iterate_.is_finite(system.team);
  kept_.end_step(result, update_.size());
  return result;
}

}  // namespace keyblock::dynamics
