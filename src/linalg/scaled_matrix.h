#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "linalg/block_order.h"
#include "linalg/block_solver.h"
#include "linalg/upper_pattern.h"

namespace keyblock::linalg {

/// The matrix of conjugate residuals, scaled so that its diagonal blocks are one: with A_jj = C_j C_jᵀ,
///
///     A = C (Uᵀ + 1 + U) Cᵀ,     U_ij = C_i⁻¹ A_ij C_j⁻ᵀ strictly above the diagonal
///
/// A and C⁻¹ have double precision. U and C have single precision: half the memory to read in every iteration, and half the instructions.
class ScaledMatrix {
 public:
  using Vector = std::vector<float>;
  using WideVector = std::vector<double>;

  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs);
  /// As those of BlockSolver; factor() finds C and U. team may be null.
  void clear(ThreadTeam* team);
  [[nodiscard]] double* diagonal(int block) {
    return &values_[pattern_.diagonal[order_.position[at(block)]]];
  }
  [[nodiscard]] BlockSlot slot(int pair) const { return slots_[at(pair)]; }
  void touch(int block) {
    const std::size_t position = order_.position[at(block)];
    if (std::exchange(stale_[position], std::uint8_t{1}) == 0)
      stale_positions_.push_back(static_cast<std::uint32_t>(position));
  }
  [[nodiscard]] bool factor(ThreadTeam* team);

  [[nodiscard]] const BlockOrder& order() const { return order_; }
  [[nodiscard]] const UpperPattern& pattern() const { return pattern_; }
  /// A_jj, followed by the blocks above it in column j.
  [[nodiscard]] const double* column(std::size_t j) const { return &values_[pattern_.diagonal[j]]; }
  [[nodiscard]] const double* values() const { return values_.data(); }
  [[nodiscard]] const double* inverse(std::size_t j) const {
    return &inverse_[pattern_.inverse_start[j]];
  }  ///< C_j⁻¹
  [[nodiscard]] const float* scale(std::size_t j) const {
    return &scale_[pattern_.inverse_start[j]];
  }  ///< C_j
  /// U, by paired_columns where all blocks have 6 unknowns.
  [[nodiscard]] const float* above() const { return above_.data(); }
  /// U of UpperPattern::row_entries once more, in their order: where rows gather from above(), they wait for the memory at each block.
  [[nodiscard]] const float* above_by_rows() const { return above_by_rows_.data(); }

 private:
  void scale_block(std::size_t i, std::size_t j, const double* a, double* scaled) const;
  void store_scaled(std::size_t i, std::size_t j, const double* scaled, float* above) const;
  [[nodiscard]] bool scale_diagonal(std::size_t j, WideVector& scratch);
  void scale_above(std::size_t j, WideVector& scratch);
  void copy_row_between(std::size_t row);
  [[nodiscard]] bool factor_all(ThreadTeam* team);
  [[nodiscard]] bool factor_touched();

  BlockOrder order_;
  UpperPattern pattern_;
  std::vector<BlockSlot> slots_;
  WideVector values_;   ///< A
  WideVector inverse_;  ///< C_j⁻¹
  Vector scale_;        ///< C_j
  Vector above_, above_by_rows_;
  std::vector<std::uint8_t>
      stale_;  ///< per position: what belongs to the diagonal block is to be found again
  std::vector<std::uint32_t> stale_positions_;  ///< these, unless all are stale
  bool all_stale_ = true;
  std::vector<std::uint32_t>
      touched_;  ///< scratch: positions in whose columns or rows something is to be scaled again
};

}  // namespace keyblock::linalg
