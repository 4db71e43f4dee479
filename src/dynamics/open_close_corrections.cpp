// Corrections of the open-close iteration: how the springs of a step that act otherwise than the matrix has them come to be known.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "dynamics/open_close.h"

namespace keyblock::dynamics {

namespace {

// Of the tolerance of a step, what the factor of an earlier step may leave over: next to nothing, as one refinement
// takes three digits.
constexpr double kept_share = 0.003;

}  // namespace

/// −∇Π at D = 0 into direction_, with all springs on the straight lines of the factored matrix.
void OpenClose::start_on_lines(const StepProblem& problem) {
  std::copy(problem.right().begin(), problem.right().end(), direction_.begin());
  const auto minus_gradient = [&](std::size_t c) {
    return -1.0 *
           problem.rows()[c].gradient(springs_->force_on(c, factored_[c], springs_->y0[c], springs_->w0[c]));
  };
  problem.add_contact_forces(minus_gradient, vertex_force_, direction_);
}

/// Springs and their pieces at D.
void OpenClose::place(const StepProblem& problem, std::span<const double> d) {
  problem.displace(d, displacement_);
  for_relatives(problem.rows(), [&](std::size_t c, std::size_t count, const Relatives& r) {
    for (std::size_t i = 0; i < count; ++i)
      store_pair(r_[c + i], r.each[i] + load_pair(problem.rows()[c + i].moved));
    springs_->stretch(c, count, r.normal, r.tangent);
  });
  knows_relative_ = true;
}

/// Contacts that are not on the straight lines of the matrix, into bends_.
void OpenClose::find_bent() {
  constexpr std::size_t group = 32;
  const auto any_bent_from = [&](std::size_t c) {
    return std::memcmp(&springs_->piece[c], &factored_[c],
                       std::min(group, factored_.size() - c) * sizeof(Piece)) != 0;
  };
  const auto is_bent = [&](std::size_t c) { return springs_->piece[c] != factored_[c]; };
  find_few<group>(*team_, springs_->size(), contacts_worth_threads, any_bent_from, is_bent, bends_);
}

/// Springs of the contacts in bends_ that are not corrected yet, into wanted_.
void OpenClose::find_wanted() {
  wanted_.clear();
  for (const std::size_t c : bends_) {
    const Piece is = springs_->piece[c], line = factored_[c];
    for (const bool normal : {true, false}) {
      const Corrected spring{c, normal};
      if (normal ? is.closed == line.closed : is.shear == line.shear) continue;
      if (std::find(corrected_.begin(), corrected_.end(), spring) == corrected_.end())
        wanted_.push_back(spring);
    }
  }
}

/// Those in wanted_ are corrected from now on.
void OpenClose::correct_wanted(const StepProblem& problem, linalg::HalfSolver& halves) {
  for (const Corrected spring : wanted_) {
    const StepProblem::Row& row = problem.rows()[spring.contact];
    problem.derivative(row, spring.normal ? -1.0 * row.normal : row.tangent(), part_a_, part_b_);
    corrections_.add(halves, {row.unknown_a, part_a_}, {row.unknown_b, part_b_});
    corrected_.push_back(spring);
    std::erase_if(free_, [&](std::size_t b) {
      return problem.unknown(b) == row.unknown_a || problem.unknown(b) == row.unknown_b;
    });
  }
}

/// How the forces of the springs that are corrected change on the way from D. The last `fresh` of them are on the straight lines of the
/// matrix so far. False when that is not found.
bool OpenClose::find_corrections(const linalg::HalfSolver& halves, std::size_t fresh) {
  laws_.clear();
  stretch_.clear();
  correction_force_.assign(corrected_.size(), 0.0);
  for (std::size_t k = 0; k < corrected_.size(); ++k) {
    const auto [c, normal] = corrected_[k];
    const Force constant = springs_->force_on(c, factored_[c], 0.0, 0.0);
    // A spring that the matrix has with another stiffness keeps that, stretched so that its force at D is right.
    const double in_matrix = normal ? factor_.normal_stiffness[c] : factor_.shear_stiffness[c];
    const double now = normal ? springs_->kn[c] : springs_->ks[c];
    const double stiffness = in_matrix > 0.0 ? in_matrix : now, scale = now / stiffness;
    stretch_.push_back(scale * (normal ? springs_->y[c] : springs_->w[c]));
    Corrections::Law& law = laws_.emplace_back();
    law.stiffness = stiffness;
    law.low = normal ? springs_->floor[c] : -springs_->bound[c];
    law.high = normal ? HUGE_VAL : springs_->bound[c];
    law.line_stiffness = in_matrix;
    law.line_force = normal ? constant.normal : constant.shear;
    const bool is_fresh = k + fresh >= corrected_.size();
    if (!is_fresh) correction_force_[k] = law.bend(stretch_.back());
    law.line_force += correction_force_[k];
  }
  if (!corrections_.solve(halves, base_, laws_, stretch_)) return false;
  for (std::size_t k = 0; k < corrected_.size(); ++k) correction_force_[k] += corrections_.forces()[k];
  return true;
}

/// By how much the force of a contact differs from its straight line in the matrix.
SpringArray::Force OpenClose::bend_from_matrix(std::size_t c) const {
  return springs_->force(c) - springs_->force_on(c, factored_[c], springs_->y[c], springs_->w[c]);
}

/// Takes the force of one spring out of the gradient.
void OpenClose::leave_out(const StepProblem& problem, Corrected spring, double force) {
  add_force(problem, spring.contact, {spring.normal ? force : 0.0, spring.normal ? 0.0 : force}, -1.0,
            gradient_);
}

/// ∇Π where all but the springs that bend are on the straight lines of a matrix that has been solved exactly: what these do otherwise than
/// they have been corrected to.
void OpenClose::find_rest(const StepProblem& problem) {
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  gradient_changed();
  for (const std::size_t c : bends_) add_force(problem, c, bend_from_matrix(c), 1.0, gradient_);
  for (std::size_t k = 0; k < corrected_.size(); ++k) leave_out(problem, corrected_[k], correction_force_[k]);
}

void OpenClose::forget_corrections() {
  corrections_.clear();
  corrected_.clear();
}

/// ∇Π at D, where the springs are.
void OpenClose::find_gradient(const StepProblem& problem, std::span<const double> d) {
  problem.gradient(
      d, [&](std::size_t c) { return problem.rows()[c].gradient(springs_->force(c)); }, vertex_force_,
      gradient_);
  gradient_changed();
}

/// Takes out of the gradient what the springs in wanted_, which the increment knows nothing of, do otherwise than the matrix has them.
void OpenClose::leave_out_bends(const StepProblem& problem) {
  for (const Corrected spring : wanted_) {
    const Force force = bend_from_matrix(spring.contact);
    leave_out(problem, spring, spring.normal ? force.normal : force.shear);
  }
  if (!wanted_.empty()) gradient_changed();
}

/// Against the gradient, into direction_.
void OpenClose::turn_against_gradient(std::size_t unknowns) {
  std::transform(gradient_.begin(), gradient_.begin() + static_cast<std::ptrdiff_t>(unknowns),
                 direction_.begin(), std::negate());
}

/// The way that the springs on their lines would go, in `direction`, becomes that with the springs that are corrected. False when their
/// forces are not found; none are corrected then.
bool OpenClose::solve_corrected(linalg::HalfSolver& halves, std::size_t fresh, std::span<double> direction) {
  {
    const Profile::Scope scope(*profile_, Phase::solution);
    halves.half_solve(direction, base_);
  }
  if (!find_corrections(halves, fresh)) {
    forget_corrections();
    return false;
  }
  const Profile::Scope scope(*profile_, Phase::solution);
  corrections_.finish(halves, base_, direction);
  return true;
}

/// The first way from D, into `direction`. False when it is not found.
bool OpenClose::begin_correcting(const StepProblem& problem, linalg::BlockSolver& solver, double enough,
                                 bool from_zero, std::span<double> direction) {
  linalg::HalfSolver& halves = *solver.halves();
  if (!from_zero) {
    find_bent();
    find_wanted();
    leave_out_bends(problem);
    turn_against_gradient(direction.size());
    return solve_corrected(halves, 0, direction);
  }
  start_on_lines(problem);
  if (kept_ || halves.is_exact()) return solve_corrected(halves, corrected_.size(), direction);
  // A long way: what its last digits lack would have springs seem to act otherwise that do not.
  const Profile::Scope scope(*profile_, Phase::solution);
  solver.solve(direction, std::span(residual_).first(direction.size()), excess_over(problem, enough),
               linalg::BlockSolver::Residual::estimated);
  return solver.solved();
}

/// D ← D + direction; springs that act otherwise than the matrix has them there and are not corrected yet, into wanted_.
void OpenClose::go_corrected(const StepProblem& problem, std::span<const double> direction,
                             std::span<double> d, OpenCloseResult& result) {
  ++result.iterations;
  in_lanes(static_cast<int>(direction.size()), [&](int k, int count) {
    store_first(&d[at(k)], load_first(&d[at(k)], count) + load_first(&direction[at(k)], count), count);
  });
  for (const std::size_t b : free_) problem.solve_alone(b, d);
  place(problem, d);
  find_bent();
  find_wanted();
}

/// As correct(), but for the gradient.
bool OpenClose::correct_until_done(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                                   bool from_zero, std::span<double> d, OpenCloseResult& result) {
  const std::span<double> direction = std::span(direction_).first(problem.unknowns());
  const double enough = (kept_ ? kept_share : linear_share) * tolerance;
  if (!begin_correcting(problem, solver, enough, from_zero, direction)) return false;
  go_corrected(problem, direction, d, result);
  for (int refinements = 0;;) {
    if (corrected_.size() + wanted_.size() > most_corrected) return false;
    correct_wanted(problem, *solver.halves());
    const std::size_t fresh = wanted_.size();
    // What the factor gets wrong is refined away at the end, until nothing of it is left, and what that of an earlier step does
    // along with the first springs that come to be corrected.
    const bool refines = fresh == 0 ? !is_exact(solver) : kept_ && refinements == 0;
    if (refines) {
      find_gradient(problem, d);
      leave_out_bends(problem);
    }
    const bool fits = !refines || out_of_balance(problem) <= enough;
    if (fits && fresh == 0) return true;
    if (fits) {
      std::ranges::fill(direction, 0.0);
    } else {
      if (refinements++ == most_refinements) return false;
      ++result.refinements;
      turn_against_gradient(direction.size());
    }
    if (!solve_corrected(*solver.halves(), fresh, direction)) return false;
    go_corrected(problem, direction, d, result);
  }
}

/// Goes from D, where springs and gradient are, or from zero, where the gradient need not be, to the minimum with the factor at hand,
/// correcting the springs that act otherwise. They become more until no other does, so that this ends. False when they are too many, when
/// their forces are not found, and when what the factor gets wrong is not refined away; springs and gradient are those of D in any case.
bool OpenClose::correct(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                        bool from_zero, std::span<double> d, OpenCloseResult& result) {
  if (!correct_until_done(problem, solver, tolerance, from_zero, d, result)) {
    if (!knows_relative_) place(problem, d);
    find_gradient(problem, d);
    return false;
  }
  if (is_exact(solver)) find_rest(problem);
  result.bends += corrected_.size();
  return true;
}

}  // namespace keyblock::dynamics
