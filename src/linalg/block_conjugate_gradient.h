#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/huge_pages.h"
#include "core/index.h"
#include "linalg/block_solver.h"

namespace keyblock::linalg {

/// make_block_conjugate_gradient(). Its pattern is found in block_conjugate_gradient_pattern.cpp.
///
/// Blocks are scaled so that those on the diagonal are one: with A_jj = C_j C_jᵀ, the matrix is C (L + 1 + Lᵀ) Cᵀ with
/// L_ij = C_i⁻¹ A_ij C_j⁻ᵀ strictly below the diagonal. Preconditioned from both sides by (1 + L) it is
///
///     Â y = t + (1 + L)⁻¹ (y − t),     t = (1 + Lᵀ)⁻¹ y
///
/// L and the vectors have single precision: half the memory to read in every iteration, and half the instructions. A few digits of
/// the solution are found so; the residual is then that of the matrix itself, and asks for more where they do not do.
/// Vectors are padded as the blocks are. In the order of `partition`, the parts are solved for at the same time, by as many threads
/// as there are; sums go part by part.
class BlockConjugateGradient final : public BlockSolver {
 public:
  explicit BlockConjugateGradient(ThreadTeam* team) : team_(team) {}
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override;
  double* diagonal(int block) override { return &matrix_[diagonal_[place_[at(block)]]]; }
  BlockSlot slot(int pair) override { return slots_[at(pair)]; }
  void touch(int block) override { stale_[place_[at(block)]] = 1; }
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess) override;
  [[nodiscard]] bool solved() const override { return solved_; }

 private:
  using Vector = HugePageVector<float>;
  using WideVector = HugePageVector<double>;
  struct Range {
    std::size_t first, last;  ///< places
  };

  void place_vectors(std::span<const int> sizes, std::span<const int> order);
  std::vector<std::size_t> place_matrix(std::span<const std::pair<int, int>> pairs);
  template <typename Body>
  void for_parts(const Body& body) const;
  template <typename Body>
  void for_ranges(const Body& body) const;
  template <typename Body>
  double sum_over_ranges(const Body& body);
  [[nodiscard]] Range between() const { return {begin_[begin_.size() - 2], begin_.back()}; }
  template <auto place, typename Number>
  void subtract_lower(const Number* values, const Number* x, Number* y, Range range) const;
  template <auto place, typename Number>
  void subtract_lower_between(const Number* values, const Number* x, Number* y) const;
  template <auto place, typename Number>
  void subtract_upper(const Number* values, const Number* x, Number* y, Range range) const;
  void divide_forward(Vector& v) const;
  void backward(Vector& v, Range range) const;
  void divide_backward(Vector& v) const;
  template <typename Body>
  void padded(Range range, const Body& body) const;
  double apply(double beta);
  double go(double alpha);
  void scale(std::span<const double> x);
  void unscale(std::size_t j, const Vector& v, double* x);
  void find_residual(std::span<double> residual);
  void take_over(const Vector& v, std::span<double> x, std::span<double> residual);
  void scale_block(std::size_t i, std::size_t j, const double* a, double* scaled) const;
  int iterate(double too_large, const Excess& excess, int most);

  struct Entry {
    std::uint32_t row;     ///< > column
    std::uint32_t values;  ///< into matrix_
    std::uint32_t lower;   ///< into lower_
  };
  // Everything is by place in the order of the partition, but for the slots.
  ThreadTeam* team_;
  std::vector<std::size_t> place_;  ///< block → place
  std::vector<std::size_t> begin_;  ///< Partition::begin
  std::vector<int> size_, stride_;
  std::vector<std::size_t> offset_;       ///< its unknowns in x
  std::vector<std::size_t> start_;        ///< into padded vectors
  std::vector<std::size_t> entry_start_;  ///< per column, into entries_
  std::vector<std::size_t>
      between_start_;  ///< per column, likewise: the first whose row lies between the parts
  std::vector<Entry> entries_;
  struct RowEntry {
    std::size_t column, entry;
  };
  std::vector<std::size_t> row_start_;      ///< per block between the parts, into row_entries_
  std::vector<std::size_t> row_between_;    ///< likewise: the first whose column lies between the parts too
  std::vector<RowEntry> row_entries_;       ///< of a row, by columns
  std::vector<std::size_t> diagonal_;       ///< into matrix_
  std::vector<std::size_t> inverse_start_;  ///< into inverse_
  std::vector<BlockSlot> slots_;
  WideVector matrix_;            ///< A
  WideVector inverse_;           ///< C_j⁻¹
  HugePageVector<float> lower_;  ///< L
  std::vector<std::uint8_t> stale_;
  int largest_ = 0;               ///< stride of a block
  Vector t_, z_, r_, p_, q_;      ///< padded
  WideVector wide_, product_;     ///< padded: scratch
  std::vector<double> estimate_;  ///< of the residual
  std::vector<double> sums_;      ///< per range
  bool solved_ = true;
};

}  // namespace keyblock::linalg
