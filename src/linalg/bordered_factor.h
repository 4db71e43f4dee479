#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "linalg/registers.h"

namespace keyblock::linalg {

/// L D Lᵀ of a dense symmetric matrix that changes from its end: rows before the first that changed are kept. There are no pivots, so that it
/// is for matrices that need none in any order: positive definite in some rows and negative definite in the others.
///
/// Eight rows at a time are a group; a number of each is a register. The last group is filled up with rows of the unit matrix.
class BorderedFactor {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }
  /// No row is kept.
  void clear() { size_ = 0; }
  /// Of a matrix of n rows, of which the first `kept` are those of the last call; entry(i, j): of the others, j ≤ i. False when a pivot is
  /// zero or no number; then no row is kept.
  template <typename Entry>
  [[nodiscard]] bool factor(std::size_t n, std::size_t kept, const Entry& entry);
  /// x ← A⁻¹ x, of size() numbers.
  void solve(std::span<double> x);

 private:
  static constexpr std::size_t width = lane_count;
  /// Numbers of the groups before group g.
  static std::size_t start(std::size_t g) { return width * width * g * (g + 1) / 2; }
  double* column(std::size_t g, std::size_t j) { return &values_[start(g) + j * width]; }
  template <typename Entry>
  void load_rows(std::size_t g, const Entry& entry);
  void eliminate(std::size_t g, std::size_t h);
  [[nodiscard]] bool factor_diagonal(std::size_t g);

  std::size_t size_ = 0;
  std::vector<double> values_;   ///< L by groups, each by columns, up to its diagonal block
  std::vector<double> inverse_;  ///< per row: 1 / D
  std::vector<double> scaled_;   ///< scratch: L D of a group
  std::vector<double> right_;    ///< scratch
};

/// out += scale · row, of n numbers; both have room for n rounded up to whole registers.
void add_multiple(double scale, const double* row, std::size_t n, double* out);

/// What the matrix has in the rows of group g, up to the diagonal.
template <typename Entry>
void BorderedFactor::load_rows(std::size_t g, const Entry& entry) {
  for (std::size_t j = 0; j < (g + 1) * width; ++j) {
    double* to = column(g, j);
    for (std::size_t i = g * width; i < (g + 1) * width; ++i)
      *to++ = i < j ? 0.0 : i < size_ ? entry(i, j) : i == j ? 1.0 : 0.0;
  }
}

template <typename Entry>
bool BorderedFactor::factor(std::size_t n, std::size_t kept, const Entry& entry) {
  const std::size_t groups = (n + width - 1) / width;
  std::size_t g = std::min(kept, size_) / width;
  size_ = n;
  if (values_.size() < start(groups)) values_.resize(start(groups + 2));
  inverse_.resize(groups * width);
  scaled_.resize(groups * width * width);
  for (; g < groups; ++g) {
    load_rows(g, entry);
    for (std::size_t h = 0; h < g; ++h) eliminate(g, h);
    if (factor_diagonal(g)) continue;
    clear();
    return false;
  }
  return true;
}

}  // namespace keyblock::linalg
