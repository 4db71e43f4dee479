// Corrections of the open-close iteration: how the springs of a step that act otherwise than the matrix has them come to be known.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "dynamics/open_close.h"

namespace keyblock::dynamics {

namespace {

// Of the tolerance of a step, what the factor of an earlier step may leave over: next to nothing, as one refinement
// takes three digits.
constexpr double kept_share = 0.003;

}  // namespace

/// Half of D₀, where all springs are on the straight lines of the factored matrix.
void OpenClose::solve_base(const StepProblem& problem, linalg::HalfSolver& halves) {
  std::copy(problem.right().begin(), problem.right().end(), direction_.begin());
  const auto minus_gradient = [&](std::size_t c) {
    return -1.0 *
           problem.rows()[c].gradient(springs_->force_on(c, factored_[c], springs_->y0[c], springs_->w0[c]));
  };
  problem.add_contact_forces(minus_gradient, vertex_force_, direction_);
  const Profile::Scope scope(*profile_, Phase::solution);
  halves.half_solve(std::span(direction_).first(problem.unknowns()), base_);
}

/// Springs and their pieces at D.
void OpenClose::place(const StepProblem& problem, std::span<const double> d) {
  const auto& rows = problem.rows();
  problem.displace(d, displacement_);
  team_->for_range(rows.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const Vec2 r = rows[c].relative(displacement_);
      r_[c] = r + rows[c].moved;
      springs_->y[c] = springs_->y0[c] - dot(rows[c].normal, r);
      springs_->w[c] = springs_->w0[c] + dot(rows[c].tangent(), r);
      springs_->piece[c] = springs_->piece_at(c, springs_->y[c], springs_->w[c]);
    }
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

/// Springs of the contacts in bends_ that are not corrected yet become so. How many there were; −1: too many.
int OpenClose::correct_bends(const StepProblem& problem, linalg::HalfSolver& halves) {
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
  if (corrected_.size() + wanted_.size() > most_corrected) return -1;
  for (const Corrected spring : wanted_) {
    const StepProblem::Row& row = problem.rows()[spring.contact];
    problem.derivative(row, spring.normal ? -1.0 * row.normal : row.tangent(), part_a_, part_b_);
    corrections_.add(halves, {row.unknown_a, part_a_}, {row.unknown_b, part_b_});
    corrected_.push_back(spring);
    std::erase_if(free_, [&](std::size_t b) {
      return problem.unknown(b) == row.unknown_a || problem.unknown(b) == row.unknown_b;
    });
  }
  return static_cast<int>(wanted_.size());
}

/// The forces of the springs that are corrected. False when they are not found.
bool OpenClose::find_corrections(const linalg::HalfSolver& halves) {
  laws_.clear();
  stretch_.clear();
  for (const Corrected spring : corrected_) {
    const std::size_t c = spring.contact;
    const Piece line = factored_[c];
    const Force constant = springs_->force_on(c, line, 0.0, 0.0);
    // A spring that the matrix has with another stiffness keeps that, stretched so that its force at D = 0 is right.
    const double in_matrix = spring.normal ? factor_.normal_stiffness[c] : factor_.shear_stiffness[c];
    const double now = spring.normal ? springs_->kn[c] : springs_->ks[c];
    const double stiffness = in_matrix > 0.0 ? in_matrix : now, scale = now / stiffness;
    if (spring.normal) {
      laws_.push_back({stiffness, springs_->floor[c], HUGE_VAL, in_matrix, constant.normal});
      stretch_.push_back(scale * springs_->y0[c]);
    } else {
      laws_.push_back({stiffness, -springs_->bound[c], springs_->bound[c], in_matrix, constant.shear});
      stretch_.push_back(scale * springs_->w0[c]);
    }
  }
  return corrections_.solve(halves, base_, laws_, stretch_);
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
  out_of_balance_.reset();
}

/// Takes out of the gradient what the springs in wanted_, which the increment knows nothing of, do otherwise than the matrix has them.
void OpenClose::leave_out_bends(const StepProblem& problem) {
  for (const Corrected spring : wanted_) {
    const std::size_t c = spring.contact;
    const Force bend =
        springs_->force(c) - springs_->force_on(c, factored_[c], springs_->y[c], springs_->w[c]);
    add_force(problem, c, {spring.normal ? bend.normal : 0.0, spring.normal ? 0.0 : bend.shear}, -1.0,
              gradient_);
  }
  if (!wanted_.empty()) out_of_balance_.reset();
}

/// Goes to the minimum with the factor at hand, correcting the springs that act otherwise. They become more until no other does, so
/// that this ends. False when they are too many, or their forces are not found; D and the gradient are then those of the corrections
/// so far, or of none; and when the factor of an earlier step will not do.
bool OpenClose::correct(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                        std::span<double> d, OpenCloseResult& result) {
  linalg::HalfSolver& halves = *solver.halves();
  const std::span<double> unknown = d.first(problem.unknowns());
  const auto finish = [&] {
    ++result.iterations;
    const Profile::Scope scope(*profile_, Phase::solution);
    corrections_.finish(halves, base_, unknown);
    for (const std::size_t b : free_) problem.solve_alone(b, unknown);
  };
  solve_base(problem, halves);
  std::fill(d.begin(), d.end(), 0.0);
  bool done = false;
  for (int refinements = 0;;) {
    if (corrections_.size() > 0 && !find_corrections(halves)) {
      forget_corrections();
      finish();
      place(problem, d);
      find_bent();
      break;
    }
    finish();
    place(problem, d);
    find_bent();
    const int added = correct_bends(problem, halves);
    done = added == 0;
    if (added < 0 || (done && !kept_)) break;
    // What the factor of an earlier step gets wrong is refined away along with the first springs that come to be corrected,
    // and at the end until nothing of it is left.
    if (!kept_ || (!done && refinements > 0)) continue;
    find_gradient(problem, d);
    if (!done) leave_out_bends(problem);
    const bool fits = out_of_balance(problem) <= kept_share * tolerance;
    if (fits && done) return true;
    if (fits) continue;
    if (refinements++ == most_refinements) return false;
    ++result.refinements;
    const Profile::Scope scope(*profile_, Phase::solution);
    halves.half_solve(std::span(gradient_).first(problem.unknowns()), refinement_);
    for (std::size_t k = 0; k < base_.size(); ++k) base_[k] -= refinement_[k];
  }
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  out_of_balance_.reset();
  for (const std::size_t c : bends_) {
    const double y = springs_->y[c], w = springs_->w[c];
    add_force(problem, c, springs_->force(c) - springs_->force_on(c, factored_[c], y, w), 1.0, gradient_);
  }
  for (std::size_t s = 0; s < corrections_.size(); ++s) {
    const double force = corrections_.forces()[s];
    const bool normal = corrected_[s].normal;
    add_force(problem, corrected_[s].contact, {normal ? force : 0.0, normal ? 0.0 : force}, -1.0, gradient_);
  }
  return done;
}

}  // namespace keyblock::dynamics
