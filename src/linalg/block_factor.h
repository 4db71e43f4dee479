#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "linalg/block_matrix.h"
#include "linalg/block_pattern.h"
#include "linalg/block_solver.h"

namespace keyblock::linalg {

/// poor: a pivot is less than the given share of what the matrix has in its place, so that few digits are left of it.
enum class FactorOutcome { done, not_positive, poor };

/// L of a matrix A ≈ L Lᵀ, from the left by block columns, with entries of type Number: float or double. Solutions are those of L Lᵀ in
/// double precision, so that they are symmetric whatever the entries were rounded to. As solutions of A they have the digits of the entries, less
/// the digits that the condition of A takes.
template <typename Number>
class BlockFactor {
 public:
  BlockFactor() = default;
  explicit BlockFactor(const BlockPattern& pattern);
  /// All columns, or one, are to be factored anew.
  void make_stale();
  void make_stale(std::size_t column) { stale_[column] = 1; }
  /// Factors the columns that are stale, and those that depend on them.
  [[nodiscard]] FactorOutcome factor(const BlockPattern& pattern, const BlockMatrix& matrix,
                                     double least_pivot);

  /// y ← L⁻¹ y and y ← L⁻ᵀ y, of vectors by columns.
  void forward(const BlockPattern& pattern, std::span<double> y);
  void backward(const BlockPattern& pattern, std::span<double> y);
  /// w ← L⁻¹ w of a few, each on the path from its column to the root.
  void forward(const BlockPattern& pattern, std::span<ForwardVector> ws);

 private:
  // `equal`: unknowns of every block where all have as many, so that loops have a known length; 0 where not.
  template <int equal>
  void update_column(const BlockPattern& pattern, std::size_t j);
  template <int equal>
  [[nodiscard]] bool invert_diagonal(const BlockPattern& pattern, std::size_t j);
  template <int equal>
  [[nodiscard]] FactorOutcome factor_columns(const BlockPattern& pattern, const BlockMatrix& matrix,
                                             double least_pivot);
  template <int equal, int columns>
  int gather(const BlockPattern& pattern, std::size_t j, int c, const double* y);
  template <int equal, int columns>
  int divide(const BlockPattern& pattern, std::size_t j, int c, double* y);
  template <int equal>
  void eliminate_two(const BlockPattern& pattern, std::size_t j, ForwardVector& v, ForwardVector& w);
  template <int equal>
  void eliminate_on_paths(const BlockPattern& pattern, std::size_t j, std::span<ForwardVector> ws);
  template <int equal, typename OfRow>
  void eliminate(const BlockPattern& pattern, std::size_t j, double* y, const OfRow& of_row);

  std::vector<Number> values_;       ///< as the pattern has them; diagonal blocks are L_jj⁻¹
  std::vector<std::uint8_t> stale_;  ///< per column: to be factored anew
  std::vector<Number*> target_;      ///< scratch of update_column: row → block of the column at hand
  std::vector<std::size_t> at_;      ///< scratch of forward: where each of some vectors is on its path
  std::vector<double> solved_, scale_, diagonal_;  ///< scratch of one block
};

}  // namespace keyblock::linalg
