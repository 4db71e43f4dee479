#pragma once
#include <span>

#include "contact/detection.h"
#include "core/parallel.h"
#include "coupling/step_problem.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// A step as it was solved, before it is taken: what the checks and the accounts of a step read. The state is that at its start.
struct Attempt {
  const Model& model;
  const State& state;
  const Drive& drive;
  const StepProblem& problem;                  ///< its springs are stretched by the increment
  std::span<const contact::Contact> contacts;  ///< of the first rows of the problem
  std::span<const double> increment;           ///< D, by Block::first
  std::span<const Vec2> displacement;          ///< m, per vertex of the surface, of D; 0 on fixed blocks
  std::span<const Vec2> relative;              ///< m, r of each row
  ThreadTeam& team;
};

/// What becomes of an attempt. It is taken, or tried again with what it has shown, or the step is made shorter.
enum class Verdict {
  accepted,         ///< it is taken
  moved_too_far,    ///< again: a block left the region in which contacts were looked for
  impact,           ///< again: blocks meet at speed, and get another rule of integration
  rotated,          ///< again: contacts miss the gap at the end of the step, as their blocks turn
  solver_failed,    ///< again, with a direct solver: conjugate residuals did not converge
  rotated_too_far,  ///< shorter: forces have other directions at the end of the step
  not_converged,    ///< shorter: the open-close iteration did not settle
};

/// Calls of_block(b) for the blocks that move, each once. Threads may do so at once.
template <typename OfBlock>
void for_moving_blocks(const Model& model, ThreadTeam& team, const OfBlock& of_block) {
  team.for_range(model.blocks.size(), contact::blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      if (model.moves(b)) of_block(b);
    }
  });
}

}  // namespace keyblock::dynamics
