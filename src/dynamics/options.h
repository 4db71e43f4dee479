#pragma once

namespace keyblock::dynamics {

enum class LinearSolver { block, direct };

/// How a step is solved. Defaults suit rock at engineering scale; every length is relative to the model, so that any
/// consistent set of units works.
struct SolverOptions {
  /// Weight of the end of the step in the family M(1+θ)/Δt², v ← (1+θ)D/Δt − θv: 1 Shi, 0 backward Euler.
  double theta = 1.0;
  /// Largest residual of a block over its weight for a step to count as converged.
  double tolerance = 1e-4;
  int max_iterations = 60;     ///< open-close iterations before the step is retried with half of Δt
  int max_halvings = 6;
  int max_bound_updates = 4;   ///< times the Coulomb bound is taken anew within a step
  double bound_tolerance = 0.01;  ///< L2 error of the Coulomb bounds over their norm that asks for another
  LinearSolver linear = LinearSolver::block;
};

}  // namespace keyblock::dynamics
