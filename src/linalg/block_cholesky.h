#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "linalg/block_factor.h"
#include "linalg/block_matrix.h"
#include "linalg/block_pattern.h"
#include "linalg/block_solver.h"

namespace keyblock::linalg {

/// make_block_cholesky().
class BlockCholesky final : public BlockSolver, public LowRankSolver {
 public:
  explicit BlockCholesky(Precision precision) : precision_(precision) {}
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override;
  double* diagonal(int block) override { return matrix_.diagonal(static_cast<std::size_t>(block)); }
  BlockSlot slot(int pair) override { return matrix_.slot(static_cast<std::size_t>(pair)); }
  void touch(int block) override;
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;
  [[nodiscard]] LowRankSolver* low_rank() override { return this; }
  [[nodiscard]] bool serves_later_steps() const override { return true; }
  [[nodiscard]] bool solved() const override { return solved_; }
  [[nodiscard]] bool is_exact() const override { return in_double_; }
  void forward_solve(std::span<const PairVector> vs, std::span<ForwardVector> ws) override;
  void forward_solve(std::span<const double> b, std::vector<double>& w) override;
  [[nodiscard]] double product(const ForwardVector& x, const ForwardVector& y) const override;
  void find_products(const ForwardVector& x, std::span<const ForwardVector> ys,
                     std::span<double> products) const override;
  [[nodiscard]] double product(const ForwardVector& x, std::span<const double> y) const override;
  void backward_solve(std::span<const double> w, std::span<const ForwardVector> ws,
                      std::span<const double> factor, std::span<double> x) override;

 private:
  [[nodiscard]] std::size_t column(int block) const {
    return pattern_.position[static_cast<std::size_t>(block)];
  }
  void begin_path(const PairVector& v, ForwardVector& w) const;
  [[nodiscard]] bool factor_in_double();
  void to_columns(std::span<const double> x, std::span<double> by_column) const;
  void from_columns(std::span<const double> by_column, std::span<double> x) const;
  template <typename Call>
  void with_factor(const Call& call);
  void solve_by_column(std::span<double> x);
  [[nodiscard]] bool refine(std::span<double> x, std::span<double> residual, const Excess& excess,
                            Residual kind);

  Precision precision_;
  BlockPattern pattern_;
  BlockMatrix matrix_;
  std::optional<BlockFactor<float>> single_;   ///< where it may be enough
  std::optional<BlockFactor<double>> double_;  ///< once it is needed
  bool in_double_ = false;                     ///< the factor at hand
  double share_left_ =
      0.0;  ///< of an excess, what one solution in single precision left at the most; 0: not known
  bool solved_ = true;
  // Scratch, by columns.
  std::vector<double> work_, right_, solution_;
};

}  // namespace keyblock::linalg
