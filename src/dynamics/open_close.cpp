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
constexpr double least_share = 0.25;          // of the way to a new bound
constexpr int undamped_updates = 8;           // of bounds, before all contacts go a smaller share …
constexpr double least_damping = 1.0 / 64.0;  // … and how small it gets
constexpr int most_bond_updates = 20;         // in a step, lest two bonds hand a strength to and fro
// Of the inertia behind a contact, in a step of multipliers: enough for eight contacts that push a rigid block, and the least.
constexpr double first_multiplier_share = 0.25, least_multiplier_share = 1e-3;

/// Two sums over the same.
struct Sums {
  Lanes first{}, second{};
  Sums& operator+=(const Sums& other) {
    first += other.first;
    second += other.second;
    return *this;
  }
};

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

/// Takes over what a change of a spring, which had the force `before`, does to its piece and to the gradient.
void OpenClose::take_force(const StepProblem& problem, std::size_t c, Force before) {
  springs_->piece[c] = springs_->piece_at(c, springs_->y[c], springs_->w[c]);
  add_force(problem, c, springs_->force(c) - before, 1.0, gradient_);
  gradient_changed();
}

bool OpenClose::update_bounds(StepProblem& problem, double tolerance) {
  const auto [errors, scales] = sum_of<Sums>(
      *team_, (springs_->size() + lane_count - 1) / lane_count, contacts_worth_threads / lane_count,
      [&](std::size_t group) {
        const std::size_t c = group * lane_count;
        const auto at_c = [&](const std::vector<double>& numbers) { return load(&numbers[c]); };
        const Lanes zero{}, y = at_c(springs_->y), mu = at_c(springs_->friction);
        const Lanes normal = where(y > at_c(springs_->floor), at_c(springs_->kn) * y, zero);
        // Only what the new bound does to the shear force counts: a contact that holds under both bounds is settled.
        const Lanes wanted = contact::shear_strength(mu, normal, at_c(springs_->constant)),
                    elastic = at_c(springs_->ks) * at_c(springs_->w), bound_now = at_c(springs_->bound),
                    change = largest(least(elastic, wanted), -wanted) -
                             largest(least(elastic, bound_now), -bound_now);
        const auto counts = (mu >= zero) & first_lanes(springs_->size() - c);
        return Sums{where(counts, change * change, zero), where(counts, wanted * wanted, zero)};
      });
  const double error = sum(errors), scale = sum(scales);
  const double ratio = scale > 0.0 ? std::sqrt(error / scale) : 0.0;
  if (ratio <= tolerance) return false;
  const auto bound = [&](std::size_t c) {
    return contact::shear_strength(springs_->friction[c], springs_->force(c).normal, springs_->constant[c]);
  };
  // Two contacts of a wedge may hand a bound to and fro for ever: a contact goes the share of the way that the last update
  // shows to be right for it (secant).
  const bool first = bound_steps_.empty();
  bound_steps_.resize(springs_->size());
  // More of them may do so in a ring, where a mechanism begins to move, and the share of each is wrong then. If many updates of
  // a static step have not settled it, all go half as far whenever the error does not fall by a half.
  if (problem.is_static() && ++bound_updates_ > undamped_updates && ratio > 0.5 * bound_error_)
    bound_damping_ = std::max(0.5 * bound_damping_, least_damping);
  bound_error_ = ratio;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (springs_->friction[c] < 0.0) continue;
    const double missing = bound(c) - springs_->bound[c];
    const double gained = bound_steps_[c].missing - missing;
    double share = 1.0;
    if (!first && bound_steps_[c].taken * gained > 0.0)
      share = std::clamp(bound_steps_[c].taken / gained, least_share, 1.0);
    share *= bound_damping_;
    bound_steps_[c] = {missing, share * missing};
    const Force before = springs_->force(c);
    springs_->bound[c] += share * missing;
    take_force(problem, c, before);
  }
  return true;
}

/// Uzawa's iteration with a step between the stiffness of the spring and what the inertia of the blocks adds to it. False when
/// nothing penetrates and no contact that holds has drifted by more than `tolerance`, m, or when that stalls; springs are then
/// left alone.
bool OpenClose::augment(StepProblem& problem, std::span<contact::Contact> contacts, double tolerance) {
  double worst = 0.0;
  shift_.assign(springs_->size(), {});
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (!springs_->piece[c].closed) continue;
    // n·r and t·r, but for what multipliers have added.
    const StepProblem::Row& row = problem.rows()[c];
    const double normal = springs_->y0[c] - springs_->y[c] + dot(row.normal, row.moved),
                 slip = springs_->w[c] - springs_->w0[c] + dot(row.tangent(), row.moved);
    const double penetration = -(contacts[c].gap + normal) - std::max(0.0, contacts[c].memory.offset);
    const double drift = springs_->piece[c].shear == Shear::held ? contacts[c].memory.drift + slip : 0.0;
    worst = std::max({worst, std::abs(penetration), std::abs(drift)});
    const double inertia = multiplier_share_ * problem.inertia_between(contacts[c]);
    // A multiplier pushes, or is none: a negative one would let the blocks penetrate until they have made up for it.
    const double multiplier =
        springs_->is_tensile(c) ? HUGE_VAL : std::max(0.0, springs_->y[c] - penetration);
    shift_[c] = {std::max(penetration * (1.0 + inertia / springs_->kn[c]), -multiplier),
                 drift * (1.0 + inertia / springs_->ks[c])};
  }
  if (worst <= tolerance) return false;
  // What grows is overshot: more contacts share a block, or move softer modes of it, than the share was meant for.
  const bool overshoots = worst > worst_ && multiplier_share_ > least_multiplier_share;
  if (overshoots) multiplier_share_ /= std::min(1.0 + worst / worst_, 4.0);
  // Where blocks have more constraints than unknowns the rest cannot be taken out: three updates in a row gain nothing.
  stalls_ = !overshoots && worst > 0.97 * worst_ ? stalls_ + 1 : 0;
  worst_ = worst;
  if (stalls_ == 3) return false;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (shift_[c] == Vec2{}) continue;
    const Force before = springs_->force(c);
    springs_->shift(c, shift_[c].x, shift_[c].y);
    take_force(problem, c, before);
  }
  return true;
}

/// Bonds whose shear force passes what they bear now, or what the step began with, where these differ, get what they bear now. Whether
/// there are any: a bound of before the load came would have them break that hold.
bool OpenClose::renew_bonds(const StepProblem& problem, std::span<const contact::Contact> contacts) {
  constexpr double settled = 1e-3;
  if (!problem.may_break()) return false;
  bool any = false;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (!contacts[c].memory.bonded || contacts[c].fused) continue;
    const Force before = springs_->force(c);
    const double strength =
                     contact::shear_strength(springs_->friction[c], before.normal, springs_->constant[c]),
                 bound = springs_->bound[c], elastic = std::abs(springs_->ks[c] * springs_->w[c]);
    if (elastic <= std::min(strength, bound) || std::abs(strength - bound) <= settled * bound) continue;
    springs_->bound[c] = strength;
    take_force(problem, c, before);
    any = true;
  }
  return any;
}

bool OpenClose::break_bonds(const StepProblem& problem, std::span<contact::Contact> contacts) {
  if (!problem.may_break()) return false;
  bool any = false;
  for (std::size_t c = 0; c < springs_->size(); ++c) {
    if (!contacts[c].memory.bonded || contacts[c].fused) continue;
    const Force before = springs_->force(c);
    const bool holds = std::abs(springs_->ks[c] * springs_->w[c]) <= springs_->bound[c];
    if (-before.normal <= contacts[c].tension && holds) continue;
    contacts[c].memory.bonded = false;
    springs_->constant[c] = 0.0;
    springs_->set_law(c, contacts[c].friction_coefficient * std::max(0.0, before.normal), false);
    take_force(problem, c, before);
    any = true;
  }
  return any;
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
