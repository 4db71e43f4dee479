#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/profile.h"
#include "coupling/step_problem.h"
#include "linalg/block_solver.h"
#include "model/options.h"

namespace keyblock::dynamics {

/// The contacts of a step.
struct StepContacts {
  std::span<contact::Contact> contacts;
  std::uint64_t version = 0;  ///< the same for those of the same vertices and edges; 0: not known
};

/// What is solved, and with what: all that stays the same while a step is solved, except the laws of the springs (LawUpdates).
struct StepSystem {
  StepProblem& problem;
  StepContacts contacts;
  linalg::BlockSolver& solver;
  const SolverOptions& options;
  ThreadTeam& team;
  Profile& profile;

  [[nodiscard]] SpringArray& springs() const { return problem.springs(); }
  [[nodiscard]] bool updates_by_low_rank() const {
    return options.accelerators.low_rank_update && solver.low_rank() != nullptr;
  }
  [[nodiscard]] const contact::Contact& contact(std::size_t c) const { return contacts.contacts[c]; }
  [[nodiscard]] const Row& row(std::size_t c) const { return problem.rows()[c]; }
  /// How many times what is enough the residual of a linear system is.
  [[nodiscard]] linalg::BlockSolver::Excess excess_over(double enough) const {
    return [this, enough](std::span<const double> residual) {
      return problem.terms().residual_ratio(residual) / enough;
    };
  }
};

/// What an open-close iteration did.
struct OpenCloseResult {
  bool converged = false;
  bool linear_failed = false;  ///< the linear solver gave up
  bool finite = true;          ///< what is out of balance is a number
  bool bond_broken = false;    ///< some contact lost its cohesion and tension on the way
  int iterations = 0;          ///< linear solves
  std::size_t changes = 0;     ///< contacts that changed their branch on the way, as often as they did
  int refinements = 0;         ///< corrections of what the factor of an earlier step gets wrong
  int bound_updates = 0;       ///< times the Coulomb bounds were taken anew
  bool given_up = false;       ///< at the first of them
};

}  // namespace keyblock::dynamics
