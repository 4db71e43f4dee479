#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/lanes.h"
#include "linalg/block_solver.h"
#include "linalg/scaled_matrix.h"
#include "linalg/solved_part.h"

namespace keyblock::linalg {

/// The step of an iteration: p ← γ r + β p, s ← γ Â r + β s, z ← z + α p, r ← r − α s, with γ = 1. Or none.
struct IterationStep {
  float alpha = 0.0F, beta = 1.0F, gamma = 0.0F;
};

/// Steps that the vectors have not taken yet. r and s take every step at once. p and z take two at a time, to be read and written half as
/// often: what r was before the first of the two follows from what it is and s.
struct PendingSteps {
  IterationStep last, before;  ///< before: where p and z have not taken the step before the last either
  int count = 0;               ///< of p and z
  void add(IterationStep next) {
    before = last;
    last = next;
    count = count == 1 ? 2 : 1;
  }
};

/// Dot products of an iteration, with q = Â r. They give s · s, as each s is orthogonal to the last one, and r · r after it too.
struct IterationDots {
  double rr = 0.0, rq = 0.0, qq = 0.0;
  IterationDots& operator+=(const IterationDots& other) {
    rr += other.rr;
    rq += other.rq;
    qq += other.qq;
    return *this;
  }
};

/// The vectors of conjugate residuals, and the passes over matrix and vectors that an iteration is made of.
///
/// The parts follow each other, each forward, with the memory, and backward while a cache has it; or they go at the same time, by as many threads
/// as there are. Sums go part by part.
class ResidualPasses {
 public:
  void analyse(const BlockOrder& order);
  /// r ← (1 + U)⁻¹ C⁻¹ residual, and all other vectors zero.
  void start(const ScaledMatrix& matrix, const SolvedPart& part, std::span<const double> residual);
  /// The last of the steps of r and s, and those of p and z every second time; then Â r, for the next step.
  IterationDots apply(const ScaledMatrix& matrix, const SolvedPart& part, const PendingSteps& steps);
  /// Steps by themselves, so that no vector lacks any.
  void take(const SolvedPart& part, const PendingSteps& steps);
  /// z ← 0, to continue with what a solution has so far added to x.
  void clear_solution(const SolvedPart& part);
  /// What x lacks of the solution, as the iteration has it: C (1 + U) r. It is the residual of the matrix, except for what single precision
  /// leaves.
  void estimate_residual(const ScaledMatrix& matrix, const SolvedPart& part, std::span<double> residual);
  /// x += C⁻ᵀ (1 + Uᵀ)⁻¹ z.
  void add_solution(const ScaledMatrix& matrix, const SolvedPart& part, std::span<double> x);
  /// The same, and residual −= A times what x got more.
  void add_solution(const ScaledMatrix& matrix, const SolvedPart& part, std::span<double> x,
                    std::span<double> residual);

 private:
  using Vector = ScaledMatrix::Vector;
  using WideVector = ScaledMatrix::WideVector;
  /// What takes steps: r and s alone, the last one; p and z that, too; or p and z both.
  enum class Vectors { r_and_s, all_by_one, all_by_two };
  template <Vectors vectors>
  NarrowLanes advance(const PendingSteps& steps, std::size_t k);
  template <Vectors vectors, typename Layout, typename Some>
  void forward_pass(const ScaledMatrix& matrix, Layout layout, Some positions, const PendingSteps& steps);
  template <typename Layout, typename Some>
  [[nodiscard]] IterationDots backward_pass(const ScaledMatrix& matrix, Layout layout, Some positions);
  template <typename Layout, typename Some>
  void correct(const ScaledMatrix& matrix, Layout layout, Some positions, std::span<double> x);

  Vector t_, z_, r_, p_, q_, s_;     ///< padded; between iterations Â r is in t_
  WideVector wide_, product_;        ///< padded: scratch
  std::vector<IterationDots> dots_;  ///< per piece
};

}  // namespace keyblock::linalg
