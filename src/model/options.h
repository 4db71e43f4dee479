#pragma once
#include <optional>
#include <utility>

#include "model/rayleigh_damping.h"

namespace keyblock::dynamics {

/// automatic: block factors, or conjugate residuals where they take less; direct: a library, to check the others by.
enum class LinearSolver { automatic, block, iterative, direct };

/// Rules of time integration; integrator.h has the formulas.
enum class TimeIntegration { shi, average_acceleration, generalized_alpha };

/// What makes a step faster and changes where it ends by no more than its tolerance. Each can be switched off, to see what it is worth and
/// to look for a fault (`keyblock run --without NAME`). `benchmarks/ablation.py` measures what each saves.
struct Accelerators {
  bool kept_factor = true;      ///< dynamics::KeptFactor
  bool low_rank_update = true;  ///< dynamics::LowRankUpdate
  bool local_solve = true;      ///< dynamics::LocalSolve
  bool increment_history =
      true;  ///< a step begins where the last increments lead to (dynamics::IncrementHistory)
  bool earlier_attempt =
      true;  ///< an attempt begins with the springs of the attempt before it (dynamics::EarlierAttempt)
  bool steady_pairs = true;  ///< pairs of blocks that hardly moved keep their contacts (contact::Detection)
  bool single_precision = true;  ///< factors in single precision where that is enough
};

/// Their names as a user gives them.
inline constexpr std::pair<const char*, bool Accelerators::*> accelerator_names[] = {
    {"kept-factor", &Accelerators::kept_factor},
    {"low-rank-update", &Accelerators::low_rank_update},
    {"local-solve", &Accelerators::local_solve},
    {"increment-history", &Accelerators::increment_history},
    {"earlier-attempt", &Accelerators::earlier_attempt},
    {"steady-pairs", &Accelerators::steady_pairs},
    {"single-precision", &Accelerators::single_precision},
};

/// How a step is solved. Defaults suit rock at engineering scale; every length is relative to the model, so that any
/// consistent set of units works.
struct SolverOptions {
  TimeIntegration integrator = TimeIntegration::shi;
  double spectral_radius = 0.0;  ///< at infinite frequency, of generalized-α
  /// Shi: weight of the end of the step in the family M(1+θ)/Δt², v ← (1+θ)D/Δt − θv: 1 Shi, 0 backward Euler.
  double theta = 1.0;
  /// Damping of elastic vibration, as shares of critical: of the rock at the first elastic frequency of each block
  /// (stiffness-proportional, so slower motion feels less), and of each contact spring with its two blocks. Rigid motion,
  /// falling blocks and Coulomb sliding are not slowed. Without any, a block on a frictional contact feeds vibrations from
  /// its own sliding (mode coupling) as soon as Δt resolves them, and creeps below its friction angle.
  double rock_damping = 0.1;
  double contact_damping = 0.05;
  /// In the place of both, where the scenario gives it: the same share of critical at a frequency for all blocks and joints.
  std::optional<RayleighDamping> damping;
  /// Largest share of the speed of approach with which two blocks part after an impact that Δt does not resolve (ωΔt > 1,
  /// ω of the contact spring with its blocks), at more than `impact_speed`: θ of the two in the steps of the impact.
  double restitution = 0.5;
  /// `restitution` is the share with which they part, wherever in a step they meet and however short it is, and not only the largest one.
  bool keeps_restitution = false;
  /// Largest residual of a block over its weight for a step to count as converged.
  double tolerance = 1e-4;
  /// Open-close iterations of a minimization, of which a step has several, before the step is retried with half of Δt.
  int max_iterations = 60;
  int max_halvings = 6;
  /// Coulomb bounds are those of the last step unless new ones would change the shear forces by more than
  /// `bound_tolerance` of the bounds (L2 over all contacts): a first contact, an impact. They are then taken anew until
  /// less than `bound_accuracy` changes, at most `max_bound_updates` times. What is missed otherwise is owed (contact::Memory).
  double bound_tolerance = 1e-2;
  double bound_accuracy = 1e-4;
  int max_bound_updates = 8;
  /// Along a face, at the least: at its ends, and from 3 on between them, too. A block of order n has n + 1.
  int face_contacts = 2;
  double penalty = 20.0;  ///< normal stiffness of joints that give none: times Young's modulus, per metre
  LinearSolver linear = LinearSolver::automatic;
  Accelerators accelerators;

  /// β, s: by which stiffness damps the rock and its joints, in dynamic steps.
  [[nodiscard]] double stiffness_time() const { return damping ? damping->stiffness_time() : 0.0; }
};

}  // namespace keyblock::dynamics
