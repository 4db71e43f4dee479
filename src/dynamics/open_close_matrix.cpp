// The matrix of the open-close iteration: how it comes to have the springs that act.
#include <utility>

#include "core/index.h"
#include "dynamics/open_close.h"

namespace keyblock::dynamics {

/// The matrix is ∇²Π on the pieces that the contacts are on.
void OpenClose::assemble(const StepProblem& problem, linalg::BlockSolver& solver) {
  problem.assemble(solver);
  begin_factor(problem, solver);
  factored_ = springs_->piece;
  team_->for_range(factored_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      factor_.normal_stiffness[c] = springs_->normal_stiffness(c, factored_[c]);
      factor_.shear_stiffness[c] = springs_->shear_stiffness(c, factored_[c]);
      factor_.places[c] = StepProblem::Place(contacts_[c]);
    }
  });
  for (std::size_t c = 0; c < factored_.size(); ++c) {
    if (factor_.has_spring(c)) hold(problem, c, 1);
  }
  problem.add_springs(factor_.normal_stiffness, factor_.shear_stiffness, solver);
  assembled_ = true;
}

/// Contacts that are not on the straight lines of the factored matrix.
std::size_t OpenClose::bent_contacts() const {
  std::size_t count = 0;
  for (std::size_t c = 0; c < springs_->size(); ++c) count += springs_->piece[c] != factored_[c] ? 1 : 0;
  return count;
}

/// Counts what holds the blocks of a contact.
void OpenClose::hold(const StepProblem& problem, std::size_t c, int count) {
  const StepProblem::Row& row = problem.rows()[c];
  if (row.unknown_a >= 0) factor_.held[at(row.unknown_a)] += count;
  if (row.unknown_b >= 0) factor_.held[at(row.unknown_b)] += count;
}

/// Brings the matrix at hand to the pieces that the contacts are on now, and one of an earlier step to how its free blocks are turned.
/// False when it has not changed.
bool OpenClose::change_matrix(const StepProblem& problem, linalg::BlockSolver& solver) {
  const auto& rows = problem.rows();
  const bool turned = !free_.empty();
  for (const std::size_t b : free_) {
    problem.assemble_block(b, solver);
    solver.touch(problem.unknown(b));
  }
  free_.clear();
  changes_.clear();
  find_bent();
  for (const std::size_t c : bends_) {
    const Piece from = std::exchange(factored_[c], springs_->piece[c]), to = factored_[c];
    if (from.same_springs(to)) continue;
    const bool had_spring = factor_.has_spring(c);
    const double normal = springs_->normal_stiffness(c, to), shear = springs_->shear_stiffness(c, to),
                 normal_before = std::exchange(factor_.normal_stiffness[c], normal),
                 shear_before = std::exchange(factor_.shear_stiffness[c], shear);
    if (normal == normal_before && shear == shear_before) continue;
    const StepProblem::Place now(contacts_[c]), before = std::exchange(factor_.places[c], now);
    if (now == before) {
      changes_.push_back({c, now, normal - normal_before, shear - shear_before});
    } else {
      // Of an earlier step: what it has there is taken away as it was, or the matrix would not stay positive definite.
      changes_.push_back({c, before, -normal_before, -shear_before});
      changes_.push_back({c, now, normal, shear});
    }
    hold(problem, c, static_cast<int>(factor_.has_spring(c)) - static_cast<int>(had_spring));
    if (rows[c].unknown_a >= 0) solver.touch(rows[c].unknown_a);
    if (rows[c].unknown_b >= 0) solver.touch(rows[c].unknown_b);
  }
  problem.add_springs(changes_, solver);
  return turned || !changes_.empty();
}

/// Within a step only what changed is assembled and factored anew.
bool OpenClose::factor(const StepProblem& problem, linalg::BlockSolver& solver) {
  {
    const Profile::Scope scope(*profile_, Phase::assembly);
    if (!assembled_) {
      assemble(problem, solver);
    } else if (!change_matrix(problem, solver)) {
      return true;
    }
  }
  forget_corrections();
  const Profile::Scope scope(*profile_, Phase::factorization);
  return solver.factor();
}

}  // namespace keyblock::dynamics
