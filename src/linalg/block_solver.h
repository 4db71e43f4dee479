#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace keyblock::linalg {

/// Rows of a dense block are padded to a multiple of this, so that a column starts a SIMD register.
inline constexpr int row_padding = 8;
constexpr int padded_rows(int rows) {
  return (rows + row_padding - 1) / row_padding * row_padding;
}

/// Where an off-diagonal block is added to: entry (r, c) of the block is values[c · stride + r]. `row` is the
/// block whose unknowns run along the rows, `column` the other one of the pair.
struct BlockSlot {
  double* values = nullptr;
  int stride = 0;
  int row = 0;
  int column = 0;
};

class LowRankSolver;
class LocalSolver;

/// A symmetric positive definite matrix of dense blocks, of sizes that may differ, and its factorization.
///
///     analyse(sizes, pairs)   once per pattern
///     clear(); add to diagonal(i) (what is above its diagonal counts for nothing) and slot(k); factor(); solve(x)   as often as wanted
///     add to diagonal(i) and slot(k); touch(i); factor(); solve(x)                   when little has changed
///
/// solve() may be called any number of times after factor(). What only some solvers can do is asked for: low_rank(), local().
class BlockSolver {
 public:
  virtual ~BlockSolver() = default;

  /// sizes[i]: unknowns of block i. pairs: (i, j), i ≠ j, each unordered pair once; slot(k) belongs to
  /// pairs[k].
  virtual void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) = 0;
  virtual void clear() = 0;
  /// Values of the diagonal block, column by column with stride padded_rows(size).
  [[nodiscard]] virtual double* diagonal(int block) = 0;
  [[nodiscard]] virtual BlockSlot slot(int pair) = 0;
  /// Says that diagonal(block), or a slot between it and another block that is touched too, changed since factor().
  virtual void touch(int block) = 0;
  /// False when the matrix is not positive definite.
  [[nodiscard]] virtual bool factor() = 0;

  /// How many times too large a residual (as long as x) is; up to 1 it is small enough.
  using Excess = std::function<double(std::span<const double>)>;
  /// How solve() finds the residual: by a product with the matrix, or as the iteration estimates it. The estimate is enough where the residual
  /// of something else is found next.
  enum class Residual { exact, estimated };
  /// x ← A⁻¹ x; unknowns of block i start at Σ_{j<i} sizes[j]. An iterative solver stops when `excess` is at most 1, and leaves
  /// what is missing in `residual`: the x given less A times the x returned, or an estimate of it. A direct solver leaves zeros there.
  virtual void solve(std::span<double> x, std::span<double> residual, const Excess& excess,
                     Residual kind = Residual::exact) = 0;
  /// Continues from where the last solve() ended, with its x and residual, to a smaller excess: less work than to begin with the residual.
  /// A direct solver has nothing to improve.
  virtual void improve(std::span<double> /*x*/, std::span<double> /*residual*/, const Excess& /*excess*/,
                       Residual /*kind*/ = Residual::exact) {}
  /// False when the last solution gave up before its residual was small enough.
  [[nodiscard]] virtual bool solved() const { return true; }

  /// Whether the matrix and what factor() made of it may serve later steps, corrected for what they get wrong.
  [[nodiscard]] virtual bool serves_later_steps() const { return false; }
  /// Null where this solver has none.
  [[nodiscard]] virtual LowRankSolver* low_rank() { return nullptr; }
  [[nodiscard]] virtual LocalSolver* local() { return nullptr; }
};

/// L⁻¹ b, with A = L Lᵀ, of a b that belongs to one block or to two that have a pair. It is zero except in the columns on a path of the
/// elimination tree: from the first of the two blocks that is eliminated to the root.
struct ForwardVector {
  int column = -1;                  ///< where the path begins
  std::vector<double> values;       ///< of the columns on the path, those of the root first
  std::vector<std::uint32_t> path;  ///< these columns
};

/// Of a direct solver: forward substitution with the last factor, for low-rank updates. With w = L⁻¹ a, a change of A along a aᵀ needs no more
/// than products of such w with each other and one L⁻ᵀ (Woodbury's formula).
class LowRankSolver {
 public:
  virtual ~LowRankSolver() = default;
  /// Whether the factor has the digits of double precision; where not, what is solved with it has to be refined.
  [[nodiscard]] virtual bool is_exact() const = 0;
  /// What belongs to a block, as long as its unknowns; block −1: nothing.
  struct Part {
    int block = -1;
    std::span<const double> values;
  };
  /// a + b; the two blocks have a pair, or one of them is −1.
  struct PairVector {
    Part a, b;
  };
  /// w = L⁻¹ v of each, which share what is read of L on their way to the root; the same bits as one by one.
  virtual void forward_solve(std::span<const PairVector> vs, std::span<ForwardVector> ws) = 0;
  /// w = L⁻¹ b, of all columns, for a b of all blocks.
  virtual void forward_solve(std::span<const double> b, std::vector<double>& w) = 0;
  /// xᵀ y, for x = L⁻¹ a and y = L⁻¹ b that is aᵀ A⁻¹ b.
  [[nodiscard]] virtual double product(const ForwardVector& x, const ForwardVector& y) const = 0;
  /// The same of x and each y, into `products`.
  virtual void find_products(const ForwardVector& x, std::span<const ForwardVector> ys,
                             std::span<double> products) const = 0;
  [[nodiscard]] virtual double product(const ForwardVector& x, std::span<const double> y) const = 0;
  /// x = L⁻ᵀ (w + Σ factor_k ws_k).
  virtual void backward_solve(std::span<const double> w, std::span<const ForwardVector> ws,
                              std::span<const double> factor, std::span<double> x) = 0;
};

/// Of an iterative solver: systems of some blocks and the blocks near them.
class LocalSolver {
 public:
  virtual ~LocalSolver() = default;
  /// What solve_local() reads and changes, of x and residual.
  struct Reach {
    std::vector<std::size_t>
        blocks;  ///< of which it finds x, and then the blocks beside them, whose residual it changes
    std::size_t moved = 0;  ///< number of the former
  };
  /// Finds what solve_local() then reaches: these blocks and the blocks near them. False where they are so many that solve() is as well.
  [[nodiscard]] virtual bool find_local(std::span<const std::size_t> blocks, Reach& reach) = 0;
  /// As BlockSolver::solve() does, of what was reached, where all other blocks lack well less than is asked for. `residual`, which is exact,
  /// may be too large beside the blocks that move afterwards. `excess` need look at no others.
  virtual void solve_local(std::span<double> x, std::span<double> residual,
                           const BlockSolver::Excess& excess) = 0;
};

/// Digits of a factor.
enum class Precision {
  automatic,  ///< single where that saves memory from being read, and the matrix leaves enough of them
  single,     ///< where the matrix leaves enough of them
  full,       ///< double
};

/// The block Cholesky factorization of this project: left-looking by block columns, ordered by AMD on the graph of blocks. A factor in single
/// precision takes half the memory, by which solutions are bound; solve() refines what it gets by products with the matrix in double
/// precision, and forward-substituted vectors are those of a matrix that differs from it in the seventh digit.
std::unique_ptr<BlockSolver> make_block_cholesky(Precision precision = Precision::automatic);

/// Conjugate residuals with the symmetric block Gauss-Seidel preconditioner, two triangular solutions an iteration (Eisenstat
/// 1981). In a dynamic step inertia bounds the condition of the matrix, so that the iterations do not grow with the model.
/// Large systems are solved by the threads of `team`, which may be null; the bits are the same.
std::unique_ptr<BlockSolver> make_block_conjugate_residual(ThreadTeam* team);

/// The factorization of a library (Eigen) on the scalar matrix: slower at the sizes of a block system, kept as the oracle.
std::unique_ptr<BlockSolver> make_direct();

}  // namespace keyblock::linalg
