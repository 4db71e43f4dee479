#include "dynamics/open_close.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "dynamics/line_search.h"

namespace keyblock::dynamics {

namespace {

// Of what is out of balance, what linear systems may leave over: of all blocks, and near some of them, where contacts then bend again.
constexpr double forcing = 0.003, forcing_near = 0.03;
constexpr double rough_share =
    0.5;  // of what new bounds put out of balance, where the next look at them is taken
constexpr int most_bond_updates = 20;  // in a step, lest two bonds hand a strength to and fro
// Of the inertia behind a contact, in a step of multipliers: enough for eight contacts that push a rigid block.
constexpr double first_multiplier_share = 0.25;

}  // namespace

/// out += scale · ∂ψ/∂D for a contact whose springs push with `force`.
void OpenClose::add_force(const StepProblem& problem, std::size_t c, Force force, double scale,
                          std::span<double> out) {
  if (force.is_zero()) return;
  const StepProblem::Row& row = problem.rows()[c];
  problem.add_contact_force(row, scale * row.gradient(force), out);
}

/// By how much the force of a contact at D + αp differs from the straight line on which it is at D.
SpringArray::Force OpenClose::bend(std::size_t c, double alpha) const {
  const double y = springs_->y[c] + alpha * springs_->dy[c], w = springs_->w[c] + alpha * springs_->dw[c];
  return springs_->force_at(c, y, w) - springs_->force_on(c, springs_->piece[c], y, w);
}

void OpenClose::find_ratios(const StepProblem& problem) {
  if (std::exchange(knows_ratios_, true)) return;
  ratios_.resize(problem.blocks());
  team_->for_range(ratios_.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) ratios_[b] = problem.residual_ratio(b, gradient_);
  });
}

/// Largest residual ratio of a block by the gradient at hand.
double OpenClose::out_of_balance(const StepProblem& problem) {
  find_ratios(problem);
  if (!out_of_balance_) {
    out_of_balance_ =
        largest_of(*team_, ratios_.size(), blocks_worth_threads, [&](std::size_t b) { return ratios_[b]; });
  }
  return *out_of_balance_;
}

linalg::BlockSolver::Excess OpenClose::excess_over(const StepProblem& problem, double enough) {
  return [&problem, enough](std::span<const double> residual) {
    return problem.residual_ratio(residual) / enough;
  };
}

/// direction_ ← −A⁻¹ gradient_, but for what is left in residual_. False when it cannot be had.
bool OpenClose::solve_linear(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                             const OpenCloseResult& result) {
  constexpr double calm = 100.0;  // times the tolerance, out of balance
  const Profile::Scope scope(*profile_, Phase::solution);
  const std::size_t n = problem.unknowns();
  const std::span<double> x = std::span(direction_).first(n);
  // The springs that act are not known better than to a share of what is out of balance.
  const auto enough = [&](double share) {
    return std::max(linear_share * tolerance, share * out_of_balance(problem));
  };
  // Where no contact bends and little is out of balance, one system of all blocks is all that is needed.
  const bool is_calm = result.bends == 0 && out_of_balance(problem) <= calm * tolerance;
  is_near_ = !is_calm && solve_near(problem, solver, enough(forcing_near));
  if (is_near_) return solver.solved();
  team_->for_range(direction_.size(), coefficients_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) direction_[k] = -gradient_[k];
  });
  solver.solve(x, std::span(residual_).first(n), excess_over(problem, enough(forcing)),
               residual_kind(solver));
  return solver.solved();
}

/// Takes what the last linear solution left over below the share of the tolerance. False when it cannot be had.
bool OpenClose::improve_linear(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance) {
  const Profile::Scope scope(*profile_, Phase::solution);
  const std::size_t n = problem.unknowns();
  solver.improve(std::span(direction_).first(n), std::span(residual_).first(n),
                 excess_over(problem, linear_share * tolerance), residual_kind(solver));
  return solver.solved();
}

/// What the direction of search does to every spring.
void OpenClose::find_direction(const StepProblem& problem) {
  if (is_near_) return find_direction_near(problem);
  problem.displace(direction_, displacement_);
  for_relatives(problem.rows(), [&](std::size_t c, std::size_t count, const Relatives& r) {
    store_first(&springs_->dy[c], -r.normal, static_cast<int>(count));
    store_first(&springs_->dw[c], r.tangent, static_cast<int>(count));
  });
}

/// Contacts that change piece between where they are and α along the direction.
void OpenClose::find_bends(double alpha) {
  const auto bends = [&](std::size_t c) {
    const Piece p = springs_->piece_at(c, springs_->y[c] + alpha * springs_->dy[c],
                                       springs_->w[c] + alpha * springs_->dw[c]);
    return p != springs_->piece[c];
  };
  if (is_near_) {
    bends_.clear();
    std::ranges::copy_if(near_.contacts, std::back_inserter(bends_), bends);
    return;
  }
  find_few<lane_count>(
      *team_, springs_->size(), contacts_worth_threads,
      [&](std::size_t first) { return springs_->any_leaves(first, alpha); }, bends, bends_);
}

/// dΠ(D + αp)/dα given the bends up to α. With A p = −g − ρ it is g·p + α (−g·p − ρ·p) but for the bends.
double OpenClose::slope(double alpha) const {
  double sum = slope_at_zero_ + alpha * curvature_;
  for (const std::size_t c : bends_) {
    const Force extra = bend(c, alpha);
    sum += extra.normal * springs_->dy[c] + extra.shear * springs_->dw[c];
  }
  return sum;
}

double OpenClose::search_line(const StepProblem& problem) {
  const Products products = is_near_ ? products_near(problem)
                                     : sum_of<Products>(*team_, direction_.size(), coefficients_worth_threads,
                                                        [&](std::size_t k) { return products_of(k); });
  slope_at_zero_ = products.gradient;
  curvature_ = -products.residual - products.gradient;
  find_bends(1.0);
  return line_search(
      slope_at_zero_, [&](double alpha) { find_bends(alpha); }, [&](double alpha) { return slope(alpha); });
}

/// D ← D + αp, and the gradient and springs with it.
void OpenClose::go(const StepProblem& problem, double alpha, std::span<double> d) {
  for_reached_coefficients(problem, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      d[k] += alpha * direction_[k];
      gradient_[k] = (1.0 - alpha) * gradient_[k] - alpha * residual_[k];
    }
  });
  for (const std::size_t c : bends_) add_force(problem, c, bend(c, alpha), 1.0, gradient_);
  if (is_near_) {
    for (const std::size_t b : near_.blocks) ratios_[b] = problem.residual_ratio(b, gradient_);
    out_of_balance_.reset();
  } else {
    gradient_changed();
  }
  for_reached_contacts([&](std::size_t begin, std::size_t end) { springs_->go(alpha, begin, end); });
  knows_relative_ = false;
  for (const std::size_t c : bends_)
    springs_->piece[c] = springs_->piece_at(c, springs_->y[c], springs_->w[c]);
}

/// From D along a Newton direction to the minimum. False when the linear system has no solution. enough: residual ratio that is small
/// enough after it.
bool OpenClose::newton_step(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                            double enough, std::span<double> d, OpenCloseResult& result) {
  ++result.iterations;
  if (!factor(problem, solver)) return false;
  const bool was_exact = is_exact(solver);
  if (!solve_linear(problem, solver, tolerance, result)) return false;
  if (was_exact != is_exact(solver)) forget_corrections();  // they are of another factor
  find_direction(problem);
  const bool whole_way = !is_near_ && std::exchange(may_go_whole_way_, false);
  if (whole_way) find_bends(1.0);
  double alpha = whole_way ? 1.0 : search_line(problem);
  // Where no contact changes, what the system left over is all that is.
  if (!is_near_ && bends_.empty() && problem.residual_ratio(residual_) >= enough) {
    if (!improve_linear(problem, solver, tolerance)) return false;
    find_direction(problem);
    alpha = search_line(problem);
  }
  go(problem, alpha, d);
  result.bends += bends_.size();
  return true;
}

/// With corrections where the solver has halves, and Newton's method where they are too many.
bool OpenClose::minimize(const StepProblem& problem, linalg::BlockSolver& solver,
                         const SolverOptions& options, bool warm, double enough, std::span<double> d,
                         OpenCloseResult& result) {
  constexpr int most_tries = 4;
  const int limit = result.iterations + options.max_iterations;
  const bool corrects = solver.halves() != nullptr;
  const auto settled = [&] { return out_of_balance(problem) < options.tolerance; };
  // Springs are built at D = 0.
  bool from_zero = !warm && corrects && std::ranges::all_of(d, [](double v) { return v == 0.0; });
  if (!warm && corrects && !kept_ && !factor(problem, solver)) return false;
  if (!warm && !from_zero) {
    place(problem, d);
    find_gradient(problem, d);
    if (!corrects && out_of_balance(problem) <= linear_share * options.tolerance) return true;
  }
  for (int tries = corrects ? most_tries : 0; result.iterations < limit;) {
    look_at_stop();
    // The first correction has the springs of the last step; later it is worth trying where few springs differ from the matrix.
    if (tries > 0 && (result.iterations == 0 || bent_contacts() <= most_corrected / 3)) {
      --tries;
      if (correct(problem, solver, options.tolerance, std::exchange(from_zero, false), d, result) &&
          settled())
        return true;
      if (kept_) {
        if (!factor(problem, solver)) return false;
        ++tries;
        continue;
      }
    }
    if (!newton_step(problem, solver, options.tolerance, enough, d, result)) {
      if (!kept_) return false;
      assembled_ = kept_ = false;
    } else if (out_of_balance(problem) < enough) {
      if (is_exact(solver)) return true;
      // The gradient itself shows what the matrix of an earlier step, or one of few digits, got wrong. Where that is too much, another
      // Newton step takes it off, and the matrix of the next time step is its own.
      place(problem, d);
      find_gradient(problem, d);
      if (out_of_balance(problem) < enough) return true;
      if (kept_) factor_.solver = nullptr;
      ++result.refinements;
      if (misses_++ > 0) assembled_ = kept_ = false;
    }
  }
  return false;
}

/// Forgets what was known within the last step.
void OpenClose::begin(const StepProblem& problem, linalg::BlockSolver& solver, std::size_t coefficients) {
  r_.resize(problem.rows().size());
  gradient_.resize(coefficients);
  direction_.resize(coefficients);
  residual_.resize(coefficients, 0.0);
  gradient_changed();
  assembled_ = knows_relative_ = is_near_ = false;
  misses_ = 0;
  may_go_whole_way_ = solves_near(problem, solver);
  bound_steps_.clear();
  bound_updates_ = 0;
  bound_error_ = HUGE_VAL;
  bound_damping_ = 1.0;
  worst_ = HUGE_VAL;
  stalls_ = 0;
  multiplier_share_ = first_multiplier_share;
}

OpenCloseResult OpenClose::solve(StepProblem& problem, StepContacts step_contacts,
                                 linalg::BlockSolver& solver, const SolverOptions& options, ThreadTeam& team,
                                 Profile& profile, std::span<double> d,
                                 const std::function<bool()>& gives_up) {
  team_ = &team;
  const std::span<contact::Contact> contacts = step_contacts.contacts;
  contacts_ = contacts;
  contacts_version_ = step_contacts.version;
  profile_ = &profile;
  const Profile::Scope scope(profile, Phase::search);
  springs_ = &problem.springs();
  look_at_stop();
  begin(problem, solver, d.size());
  try_factor(problem, solver);
  OpenCloseResult result;
  const bool augmented = options.contact == ContactMethod::augmented_lagrangian;
  bool warm = false;
  int bond_updates = 0;
  double enough = options.tolerance;
  for (;;) {
    result.converged = minimize(problem, solver, options, warm, enough, d, result);
    if (!result.converged) {
      result.linear_failed = !solver.solved();
      break;
    }
    warm = true;
    if (let_reverse(problem, options.bound_tolerance)) continue;
    if (bond_updates < most_bond_updates && renew_bonds(problem, contacts)) {
      ++bond_updates;
      continue;
    }
    if (break_bonds(problem, contacts)) {
      result.bond_broken = true;
      continue;
    }
    if (augmented && result.multiplier_updates < options.max_multiplier_updates &&
        augment(problem, contacts, options.penetration_tolerance * problem.block_size())) {
      ++result.multiplier_updates;
      continue;
    }
    const double tolerance =
        springs_->bounds_updated || augmented ? options.bound_accuracy : options.bound_tolerance;
    if (result.bound_updates < options.max_bound_updates && update_bounds(problem, tolerance)) {
      springs_->bounds_updated = true;
      result.given_up = ++result.bound_updates == 1 && gives_up && gives_up();
      if (result.given_up) break;
      enough = std::max(options.tolerance, rough_share * out_of_balance(problem));
      continue;
    }
    if (out_of_balance(problem) < options.tolerance) break;
    enough = options.tolerance;
  }
  if (!knows_relative_) place(problem, d);
  const auto some = [&](std::size_t group) {
    const std::size_t k = group * lane_count;
    return load_first(&gradient_[k],
                      static_cast<int>(std::min<std::size_t>(lane_count, gradient_.size() - k)));
  };
  result.finite = std::isfinite(sum(sum_of<Lanes>(team, (gradient_.size() + lane_count - 1) / lane_count,
                                                  coefficients_worth_threads / lane_count, some)));
  judge_factor(result);
  return result;
}

}  // namespace keyblock::dynamics
