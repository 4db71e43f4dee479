#pragma once
#include <span>
#include <utility>
#include <vector>

#include "linalg/block_pattern.h"
#include "linalg/block_solver.h"

namespace keyblock::linalg {

/// A symmetric matrix of blocks in double precision: those on the diagonal, whose lower triangles count, and those of the pattern below it,
/// column by column in the order of elimination.
class BlockMatrix {
 public:
  BlockMatrix() = default;
  BlockMatrix(const BlockPattern& pattern, std::span<const std::pair<int, int>> pairs);
  void clear();
  [[nodiscard]] double* diagonal(std::size_t block) { return &values_[diagonal_[block]]; }
  [[nodiscard]] const double* diagonal_of_column(std::size_t j) const {
    return &values_[sources_[source_start_[j]].from];
  }
  [[nodiscard]] BlockSlot slot(std::size_t pair) const { return slots_[pair]; }
  /// Column j into where a factor has it: the values of all columns.
  template <typename Number>
  void load_column(const BlockPattern& pattern, std::size_t j, std::span<Number> values) const;
  /// y −= A x, of vectors by columns.
  void subtract_product(const BlockPattern& pattern, std::span<const double> x, std::span<double> y) const;

 private:
  struct Source {
    std::size_t from, to;  ///< into values_ and those of a factor
    std::size_t row;       ///< column of the pattern; that on the diagonal comes first
    std::size_t count;
  };
  std::vector<double> values_;
  std::vector<std::size_t> diagonal_;      ///< per block, into values_
  std::vector<Source> sources_;            ///< by column
  std::vector<std::size_t> source_start_;  ///< per column, into sources_
  std::vector<BlockSlot> slots_;
};

}  // namespace keyblock::linalg
