// Corrections of the open-close iteration: how the springs of a step that act otherwise than the matrix has them come to be known.
#include <algorithm>
#include <cmath>

#include "dynamics/open_close.h"

namespace keyblock::dynamics {

/// D₀, where all springs are on the straight lines of the factored matrix.
void OpenClose::solve_base(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                           OpenCloseResult& result) {
  ++result.iterations;
  std::copy(problem.right().begin(), problem.right().end(), direction_.begin());
  for (std::size_t c = 0; c < springs_.size(); ++c)
    add_force(problem, c, springs_.force_on(c, factored_[c], springs_.y0[c], springs_.w0[c]), -1.0,
              direction_);
  solve_linear(problem, solver, tolerance);
  base_ = direction_;
}

/// Springs and their pieces at D, and in bends_ the contacts that are not on the straight lines of the matrix.
void OpenClose::place(const StepProblem& problem, std::span<const double> d) {
  const auto& rows = problem.rows();
  team_->for_range(rows.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      const Vec2 r = problem.relative(rows[c], d);
      r_[c] = r + rows[c].moved;
      springs_.y[c] = springs_.y0[c] - dot(rows[c].normal, r);
      springs_.w[c] = springs_.w0[c] + dot(rows[c].tangent(), r);
      springs_.piece[c] = springs_.piece_at(c, springs_.y[c], springs_.w[c]);
    }
  });
  knows_relative_ = true;
  bends_.clear();
  for (std::size_t c = 0; c < rows.size(); ++c) {
    if (springs_.piece[c] != factored_[c]) bends_.push_back(c);
  }
}

/// Springs of the contacts in bends_ that are not corrected yet become so. How many there were; −1: too many.
int OpenClose::correct_bends(const StepProblem& problem, linalg::HalfSolver& halves) {
  wanted_.clear();
  for (const std::size_t c : bends_) {
    const Piece is = springs_.piece[c], line = factored_[c];
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
  }
  return static_cast<int>(wanted_.size());
}

/// The forces of the springs that are corrected. False when they are not found.
bool OpenClose::find_corrections(const StepProblem& problem) {
  laws_.clear();
  stretch_.clear();
  for (const Corrected spring : corrected_) {
    const std::size_t c = spring.contact;
    const StepProblem::Row& row = problem.rows()[c];
    const Vec2 r = problem.relative(row, base_);
    const Piece line = factored_[c];
    const Force constant = springs_.force_on(c, line, 0.0, 0.0);
    if (spring.normal) {
      laws_.push_back(
          {springs_.kn[c], springs_.floor[c], HUGE_VAL, springs_.normal_stiffness(c, line), constant.normal});
      stretch_.push_back(springs_.y0[c] - dot(row.normal, r));
    } else {
      laws_.push_back({springs_.ks[c], -springs_.bound[c], springs_.bound[c],
                       springs_.shear_stiffness(c, line), constant.shear});
      stretch_.push_back(springs_.w0[c] + dot(row.tangent(), r));
    }
  }
  return corrections_.solve(laws_, stretch_);
}

void OpenClose::forget_corrections() {
  corrections_.clear();
  corrected_.clear();
}

/// Goes to the minimum with the factor at hand, correcting the springs that act otherwise. They become more until no other does, so
/// that this ends. False when they are too many, or their forces are not found; D and the gradient are then those of the corrections
/// so far, or of none.
bool OpenClose::correct(const StepProblem& problem, linalg::BlockSolver& solver, double tolerance,
                        std::span<double> d, OpenCloseResult& result) {
  linalg::HalfSolver& halves = *solver.halves();
  solve_base(problem, solver, tolerance, result);
  bool done = false;
  for (;;) {
    std::copy(base_.begin(), base_.end(), d.begin());
    if (corrections_.size() > 0) {
      if (!find_corrections(problem)) {
        forget_corrections();
        place(problem, d);
        break;
      }
      ++result.iterations;
      const Profile::Scope scope(*profile_, Phase::solution);
      corrections_.add_to(halves, d);
    }
    place(problem, d);
    const int added = correct_bends(problem, halves);
    done = added == 0;
    if (added <= 0) break;
  }
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  for (const std::size_t c : bends_) {
    const double y = springs_.y[c], w = springs_.w[c];
    add_force(problem, c, springs_.force(c) - springs_.force_on(c, factored_[c], y, w), 1.0, gradient_);
  }
  for (std::size_t s = 0; s < corrections_.size(); ++s) {
    const double force = corrections_.forces()[s];
    const bool normal = corrected_[s].normal;
    add_force(problem, corrected_[s].contact, {normal ? force : 0.0, normal ? 0.0 : force}, -1.0, gradient_);
  }
  return done;
}

}  // namespace keyblock::dynamics
