#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "linalg/block_solver.h"
#include "linalg/neighbourhood.h"
#include "linalg/numbers.h"
#include "linalg/residual_passes.h"
#include "linalg/scaled_matrix.h"

namespace keyblock::linalg {

/// make_block_conjugate_residual().
///
/// | part | what it is |
/// |---|---|
/// | `BlockOrder`, `UpperPattern` | the partition, and where blocks are |
/// | `ScaledMatrix` | A = C (Uᵀ + 1 + U) Cᵀ |
/// | `Neighbourhood`, `SolvedPart` | some blocks and those near them; what a system is solved of |
/// | `ResidualPasses` | vectors, and passes over matrix and vectors |
///
/// Preconditioned from both sides by (1 + U) the scaled matrix is
///
///     Â r = t + (1 + U)⁻¹ (r − t),     t = (1 + Uᵀ)⁻¹ r
///
/// Conjugate residuals (Stiefel 1955) make the norm of r smallest, where conjugate gradients make that of the error: it is what is out of
/// balance that ends the iteration. With s = Â p:
///
///     β = r·Âr / (r·Âr of the last iteration),   p ← r + β p,   s ← Â r + β s,   α = r·Âr / s·s,   z ← z + α p,   r ← r − α s
///
/// Vectors have single precision. A few digits of the solution are found so; the residual is then that of the matrix itself, and asks for
/// more where they are not enough.
class BlockConjugateResidual final : public BlockSolver, public LocalSolver {
 public:
  explicit BlockConjugateResidual(ThreadTeam* team) : team_(team) {}
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override { matrix_.clear(team_); }
  double* diagonal(int block) override { return matrix_.diagonal(block); }
  BlockSlot slot(int pair) override { return matrix_.slot(pair); }
  void touch(int block) override { matrix_.touch(block); }
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;
  void improve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;
  [[nodiscard]] bool solved() const override { return solved_; }
  [[nodiscard]] bool serves_later_steps() const override { return true; }
  [[nodiscard]] LocalSolver* local() override { return this; }
  [[nodiscard]] bool find_local(std::span<const std::size_t> blocks, Reach& reach) override;
  void solve_local(std::span<double> x, std::span<double> residual, const Excess& excess) override;

 private:
  /// Of the last solutions with this matrix: by how much less the square of the residual fell than that of its norm in the scaled
  /// system; 0: not known.
  using Lags = std::array<double, numbers::remembered_solutions>;
  [[nodiscard]] SolvedPart all() const { return {matrix_.order(), nullptr, team_}; }
  void begin(const SolvedPart& part, std::span<const double> residual);
  /// What iterate() took, and whether the estimate of the residual is small enough.
  struct Iterations {
    int count;
    bool enough;
  };
  Iterations iterate(const SolvedPart& part, double too_large, const Excess& excess, int most, Lags& lags);
  [[nodiscard]] static double first_check(double first_rr, double start, const Lags& lags);
  [[nodiscard]] bool next_lengths(const IterationDots& dots, double first_rr, PendingSteps& steps,
                                  double& rr);
  void approach(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind);

  ThreadTeam* team_;
  ScaledMatrix matrix_;
  ResidualPasses passes_;
  Neighbourhood neighbourhood_;   ///< of the last find_local()
  std::vector<double> estimate_;  ///< of the residual
  Lags lags_{}, local_lags_{};
  double rho_ = 0.0;  ///< r · Â r of the last iteration; 0: the next is the first
  double ss_ = 0.0;   ///< s · s of that
  bool solved_ = true;
};

}  // namespace keyblock::linalg
