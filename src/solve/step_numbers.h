#pragma once
#include <cstddef>

/// The numbers by which a step is solved, in one place: what each is a share of, and what a larger or smaller one does. Only those
/// of attempts and of the rotation correction change where a converged step ends by more than the tolerance of the step.
namespace keyblock::dynamics::step_numbers {

// ── linear systems ───────────────────────────────────────────────────────────────────────────────────────────────────

/// Of the tolerance of a step, what its linear systems may leave over. Larger: an iteration more to converge; smaller: more digits than
/// are looked at.
inline constexpr double linear_share = 0.3;
/// Of what is out of balance, what a linear system of all blocks may leave over: rows change their branch afterwards anyway.
inline constexpr double forcing = 0.003;
/// The same of a local solve, after which rows change again.
inline constexpr double forcing_local = 0.03;
/// Times the tolerance, out of balance: up to there one system of all blocks is all that is needed where no row changed its branch.
inline constexpr double calm = 100.0;

/// Of the pairs of blocks that have contacts, how many pairs without contacts keep their room in the matrix. Larger: factors have more
/// zeros; smaller: the pattern is analysed more often.
inline constexpr double most_idle_share = 0.15;
/// Block products of a factorization, for each block, that conjugate residuals are worth (docs/performance.md).
inline constexpr double dynamic_iterations_worth = 120.0, static_iterations_worth = 450.0;
/// Blocks, beyond which not even the order of elimination is looked for.
inline constexpr std::size_t most_factored = 30'000;

// ── local solves ─────────────────────────────────────────────────────────────────────────────────────────────────────

/// Of what is enough, what blocks outside a local solve may be out of balance by.
inline constexpr double elsewhere_share = 0.5;

// ── low-rank updates and kept factors ────────────────────────────────────────────────────────────────────────────────

/// Springs, beyond which a factorization takes less than the update: one for so many blocks, within limits, as factorizations of large models
/// take longer. Hard steps of tunnels change 100 to 150.
inline constexpr std::size_t blocks_of_corrected = 6, least_corrected = 64, most_corrected = 200;
/// Springs up to which updates keep all digits of an exact factor. Beyond, the exact gradient says what they got wrong: all springs of a block
/// may be taken away, of which little is left.
inline constexpr std::size_t most_exact = 64;
/// As many as are expected in the next step, with which a factor is worth keeping.
inline constexpr std::size_t most_kept = 32;
/// More refinements than these take what a factorization does.
inline constexpr int most_refinements = 3;
/// Of the tolerance of a step, what the factor of an earlier step may leave over: next to nothing, as one refinement takes three digits.
inline constexpr double kept_share = 0.003;
/// Steps without a kept factor, at most, after it has failed again and again.
inline constexpr int longest_wait = 32;
/// Rows after each other that may be gone before those of two steps are taken for different ones.
inline constexpr std::size_t most_gone = 64;
/// Tries with a low-rank update in a minimization.
inline constexpr int most_tries = 4;

// ── bounds of friction ───────────────────────────────────────────────────────────────────────────────────────────────

/// Of what new bounds put out of balance, where bounds are looked at next.
inline constexpr double rough_share = 0.5;
/// Of the way to a new bound, what a contact goes at the least.
inline constexpr double least_bound_share = 0.25;
/// Updates of bounds in a static step before all contacts go a smaller share of their way …
inline constexpr int undamped_updates = 8;
/// … and how small it gets.
inline constexpr double least_damping = 1.0 / 64.0;

/// Error of bounds in a static step, over its tolerance, and its limits. Bounds that lag by 1 % of all forces would leave a thousandth of the
/// weight of single blocks out of balance, step after step.
inline constexpr double static_bound_share = 1e-2, most_bound_error = 1e-7, least_bound_error = 1e-12;
/// The error of bounds is an error of all contacts together, and may be the error of one small block. Where only bounds are left to be
/// found, it has to be so much less, and this many updates are worth it.
inline constexpr double settled_bound_share = 1e-4;
inline constexpr int most_static_bound_updates = 40;
/// Halvings of a static step beyond those of a dynamic one: pseudo time may have grown to many times what a block needs to pass through
/// another one.
inline constexpr int more_static_halvings = 14;

// ── bonds ────────────────────────────────────────────────────────────────────────────────────────────────────────────

/// Updates of what bonds bear in a step, lest two bonds hand a strength to and fro.
inline constexpr int most_bond_updates = 20;
/// Times that limits of couplings which go with other forces are taken anew in a step.
inline constexpr int most_limit_updates = 8;
/// Of so many events of couplings that a solution brings at once, one is taken. More: more minimizations; fewer: what breaks together may be too much.
inline constexpr std::size_t events_at_once = 10;
/// Of a bond's strength, up to which it counts as known.
inline constexpr double settled_strength = 1e-3;

// ── attempts ─────────────────────────────────────────────────────────────────────────────────────────────────────────

/// Attempts at a step, at most, where blocks move too far or strike each other. The last one is taken as it is.
inline constexpr int most_attempts = 4;
/// Attempts with a new rotation correction, before the step is made shorter.
inline constexpr int most_rotations = 4;

// ── damping ──────────────────────────────────────────────────────────────────────────────────────────────────────────

/// So many times SolverOptions::max_iterations are given to a minimization whose dashpots are stiffer than its springs. They grow
/// stiffer as the step is made shorter: the shorter step is the harder one. Smaller: steps end without convergence.
inline constexpr int damped_patience = 5;

// ── rotation correction ──────────────────────────────────────────────────────────────────────────────────────────────

/// rad, that a block in contact turns by in a step at most. Larger: forces keep a direction that they no longer have.
inline constexpr double most_rotation = 0.1;
/// The same of a block that springs hold to the ground, touched by others or not. Where it turns about a point, the springs come to be off
/// by half the square of it, of its radius; larger: they crush the block as they take that back.
inline constexpr double most_held_rotation = 0.3;
/// Work that a contact may do over what turning makes it miss. Larger: energy comes and goes without account; smaller: more steps are taken
/// again. It is a share of what lifts a mean block by its size, and of the kinetic energy where this is less.
inline constexpr double weight_work_share = 1e-3, moving_work_share = 5e-4;
/// In a static step: of what lifts a mean block by what the sides of contacts go against each other.
inline constexpr double static_work_share = 1e-4;
/// Of the kinetic energy, where there is no weight to measure work by.
inline constexpr double weightless_work_share = 1e-6;
/// Of contact::Tolerances::turn, below which a correction is not worth an attempt whatever the forces.
inline constexpr double least_rotation_share = 2e-5;
/// Of the strength of a bond, what turning may seem to stretch it by.
inline constexpr double bond_share = 0.01;

}  // namespace keyblock::dynamics::step_numbers
