#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/huge_pages.h"
#include "core/index.h"
#include "linalg/block_solver.h"

namespace keyblock::linalg {

/// make_block_cholesky(). Its pattern is found in block_cholesky_pattern.cpp.
class BlockCholesky final : public BlockSolver, public HalfSolver {
 public:
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override {
    std::fill(matrix_.begin(), matrix_.end(), 0.0);
    std::fill(stale_.begin(), stale_.end(), std::uint8_t{1});
  }
  double* diagonal(int block) override { return &matrix_[diagonal_[at(block)]]; }
  BlockSlot slot(int pair) override { return slots_[at(pair)]; }
  void touch(int block) override { stale_[position_[at(block)]] = 1; }
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;
  HalfSolver* halves() override { return this; }
  [[nodiscard]] bool serves_later_steps() const override { return true; }
  void half_solve(Part a, Part b, HalfSolution& half) override;
  void half_solve(std::span<const double> b, std::vector<double>& half) override;
  [[nodiscard]] double product(const HalfSolution& x, const HalfSolution& y) const override;
  [[nodiscard]] double product(const HalfSolution& x, std::span<const double> y) const override;
  void finish(std::span<const double> half, std::span<const HalfSolution> halves,
              std::span<const double> factor, std::span<double> x) override;

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  void find_structure(std::span<const std::pair<int, int>> pairs);
  void place_values();
  void place_matrix(std::span<const std::pair<int, int>> pairs);
  void load_column(std::size_t j);
  // `equal`: unknowns of every block where all have as many, so that loops have a known length; 0 where not.
  template <int equal>
  [[nodiscard]] int size(std::size_t column) const {
    return equal > 0 ? equal : size_[column];
  }
  template <int equal>
  [[nodiscard]] int stride(std::size_t column) const {
    return equal > 0 ? padded_rows(equal) : stride_[column];
  }
  template <int equal>
  void update_column(std::size_t j);
  template <int equal>
  bool factor_columns();
  template <int equal, int columns>
  int gather(std::size_t j, int c);
  template <int equal, int columns>
  int divide(std::size_t j, int c);
  template <int equal, typename OfRow>
  void eliminate(std::size_t j, double* y, const OfRow& of_row);
  template <int equal>
  void forward();
  template <int equal>
  void backward();
  template <int equal>
  void half_forward(HalfSolution& half);
  void take(std::span<const double> x);
  void give(std::span<double> x) const;
  template <typename Do>
  void for_equal_size(const Do& what) const;

  // Column j of the factor has its diagonal block first, then rows_[row_start_[j] … row_start_[j+1]),
  // ascending.
  std::vector<std::size_t> position_;   ///< block → column
  int equal_size_ = 0;                  ///< of all columns; 0: they differ
  std::vector<int> size_, stride_;      ///< per column
  std::vector<std::size_t> parent_;     ///< per column, in the elimination tree; none: a root
  std::vector<std::size_t> above_;      ///< per column: padded unknowns of all columns above it in that tree
  std::vector<std::size_t> row_start_;  ///< per column, into rows_ and row_value_
  std::vector<std::size_t> rows_;
  std::vector<std::size_t> row_value_;     ///< per row entry, into values_
  std::vector<std::size_t> column_value_;  ///< per column: the diagonal block, into values_
  struct Update {
    std::size_t column;  ///< k < j with a block in row j
    std::size_t entry;   ///< that block, into rows_
  };
  std::vector<std::size_t> update_start_;  ///< per column, into updates_
  std::vector<Update> updates_;
  HugePageVector<double> values_;    ///< diagonal blocks are L_jj⁻¹
  std::vector<std::size_t> offset_;  ///< per column: start of its unknowns in x, as the caller orders them
  std::vector<std::size_t> work_start_;        ///< per column: start in work_, padded
  std::vector<double> work_, solved_, scale_;  ///< scratch; the last two of one block
  std::vector<double*> target_;  ///< scratch of update_column: row → block of the column at hand
  // The matrix itself: diagonal blocks, and below them the blocks of the pattern, column by column.
  struct Source {
    std::size_t from, to;  ///< into matrix_ and values_
    std::size_t count;
  };
  HugePageVector<double> matrix_;
  std::vector<std::size_t> diagonal_;      ///< per block, into matrix_
  std::vector<Source> sources_;            ///< by column
  std::vector<std::size_t> source_start_;  ///< per column, into sources_
  std::vector<BlockSlot> slots_;
  std::vector<std::uint8_t> stale_;  ///< per column: to be factored anew
};

}  // namespace keyblock::linalg
