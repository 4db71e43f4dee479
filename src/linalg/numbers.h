#pragma once
#include <cstddef>

/// The numbers of the solvers of linear systems, in one place: unit, range, and what a larger or smaller one does. Shares are between 0 and
/// 1. Where nothing else is said, another number gives other bits.
namespace keyblock::linalg::numbers {

// ── threads and caches ───────────────────────────────────────────────────────────────────────────────────────────────

/// Blocks of a part of a partition, at most. The matrix and the vectors of a part should fit into a cache of a MB. Larger: each block comes from
/// memory twice an iteration. Smaller: more blocks lie between the parts.
inline constexpr std::size_t largest_part = 1'000;
/// Rows between the parts, and numbers of a vector, from which loops over them are worth the threads of a team. Smaller: threads wait for each
/// other longer than they compute. Any number gives the same bits.
inline constexpr std::size_t rows_worth_threads = 64, numbers_worth_threads = 20'000;
/// Of all blocks, 1 in so many may have changed to be scaled alone; otherwise all blocks are gone through. Larger: more often through all.
/// Any number gives the same bits.
inline constexpr std::size_t few_changed = 8;

// ── conjugate residuals ──────────────────────────────────────────────────────────────────────────────────────────────

/// Iterations of a solution, at most. Beyond, the solver gives up, and a step is solved by a direct one. Smaller: steps with little inertia are
/// solved by that sooner.
inline constexpr int most_iterations = 400;
/// Times the residual before, above 1: beyond that growth the matrix counts as not positive definite, and the solver gives up. Larger: more
/// iterations before it does. Smaller: it may give up where single precision lets a residual grow.
inline constexpr double most_growth = 100.0;
/// Excess of the estimated residual, with which the true residual is small enough; up to 1. Larger: solutions that have to go on. Smaller: more
/// iterations.
inline constexpr double enough_estimated = 0.9;
/// Of the square of the residual asked for: where the residual is checked for the first time, by what the last solutions took. Larger:
/// more checks, which cost more than an iteration. Smaller: more iterations than are needed.
inline constexpr double first_check_share = 0.5;
/// The same of the checks after it, by what the last check found.
inline constexpr double next_check_share = 0.5;
/// Solutions by which the first check goes, at least one. Larger: it comes as early as the quickest of more solutions needed.
inline constexpr std::size_t remembered_solutions = 3;

// ── local systems ────────────────────────────────────────────────────────────────────────────────────────────────────

/// Layers of blocks around the given blocks, over which a change is followed. Larger: larger systems. Smaller: more is left over in the
/// residual beyond.
inline constexpr int local_layers = 6;
/// Share of all blocks, beyond which a system of all takes little more. Larger: local systems that save little. Smaller: fewer local systems.
inline constexpr double most_local_share = 0.3;

// ── block Cholesky ───────────────────────────────────────────────────────────────────────────────────────────────────

/// Unknowns of a block, up to which a factor may have single precision: coefficients of higher polynomials differ too much in what they do.
/// Larger: factors with too few digits, which double precision has to replace.
inline constexpr int largest_single_block = 12;
/// Numbers of a factor, from which single precision is worth it (2 MB in double precision): a smaller factor stays in a cache as it is.
/// Smaller: refinements that save no time.
inline constexpr std::size_t worth_single = std::size_t{1} << 18;
/// Pivot over what the matrix has in its place; below that the factor has double precision. Such a pivot has no digit left in single precision.
/// Single pivots of few digits do little harm, as the residual tells what they got wrong. Larger: matrices without inertia, of static steps,
/// have factors in double precision, which take twice the time. Smaller: refinements that do not converge.
inline constexpr double least_single_pivot = 1e-7;
/// Solutions in single precision, each of what the solutions before it left over, at most; then the factor has double precision. Larger: more of
/// them for nothing. Smaller: more factors in double precision.
inline constexpr int most_refinements = 5;
/// Vectors that go to the root together. Larger: more of them wait for each other where their paths have not met.
inline constexpr std::size_t forward_group = 8;
/// An excess that is estimated to be less needs no check; below 1. Larger: solutions that have to go on.
inline constexpr double sure_excess = 0.1;

}  // namespace keyblock::linalg::numbers
