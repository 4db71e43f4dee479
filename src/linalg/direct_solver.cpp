#include <Eigen/SparseCholesky>
#include <algorithm>
#include <map>

#include "linalg/block_solver.h"

namespace keyblock::linalg {

namespace {

/// A library's factorization of single numbers, to check the solvers of blocks by.
class DirectSolver final : public BlockSolver {
 public:
  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override { std::fill(values_.begin(), values_.end(), 0.0); }
  double* diagonal(int block) override { return &values_[diagonal_[static_cast<std::size_t>(block)]]; }
  BlockSlot slot(int pair) override { return slots_[static_cast<std::size_t>(pair)]; }
  void touch(int) override {}
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;

 private:
  Eigen::SparseMatrix<double> matrix_;  ///< lower triangle
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
  std::vector<double> values_;  ///< the blocks as the caller adds to them
  std::vector<std::size_t> diagonal_;
  std::vector<BlockSlot> slots_;
  std::vector<std::size_t> source_;  ///< entry of the compressed matrix → index into values_
};

void DirectSolver::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  const std::size_t n = sizes.size();
  std::vector<int> start(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) start[i + 1] = start[i] + sizes[i];
  const auto at = [](int i) { return static_cast<std::size_t>(i); };

  diagonal_.clear();
  std::size_t used = 0;
  for (const int size : sizes) {
    diagonal_.push_back(used);
    used += at(size * padded_rows(size));
  }
  std::vector<std::size_t> value;
  for (const auto& [i, j] : pairs) {  // the larger index along the rows: the lower triangle
    value.push_back(used);
    used += at(padded_rows(sizes[at(std::max(i, j))]) * sizes[at(std::min(i, j))]);
  }
  values_.assign(used, 0.0);

  std::map<std::pair<int, int>, std::size_t> entries;  // (column, row) → index into values_
  const auto add_block = [&](int row, int column, std::size_t first) {
    for (int c = 0; c < sizes[at(column)]; ++c) {
      for (int r = row == column ? c : 0; r < sizes[at(row)]; ++r) {
        entries[{start[at(column)] + c, start[at(row)] + r}] =
            first + at(c * padded_rows(sizes[at(row)]) + r);
      }
    }
  };
  slots_.clear();
  for (std::size_t i = 0; i < n; ++i) add_block(static_cast<int>(i), static_cast<int>(i), diagonal_[i]);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [column, row] = std::minmax(pairs[k].first, pairs[k].second);
    add_block(row, column, value[k]);
    slots_.push_back({&values_[value[k]], padded_rows(sizes[at(row)]), row, column});
  }

  matrix_.resize(start[n], start[n]);
  matrix_.resizeNonZeros(static_cast<Eigen::Index>(entries.size()));
  int* column_start = matrix_.outerIndexPtr();
  std::fill(column_start, column_start + start[n] + 1, 0);
  source_.clear();
  for (const auto& [where, from] : entries) {
    matrix_.innerIndexPtr()[source_.size()] = where.second;
    source_.push_back(from);
    column_start[where.first + 1] = static_cast<int>(source_.size());
  }
  for (int c = 0; c < start[n]; ++c) column_start[c + 1] = std::max(column_start[c + 1], column_start[c]);
  factor_.analyzePattern(matrix_);
}

bool DirectSolver::factor() {
  for (std::size_t k = 0; k < source_.size(); ++k) matrix_.valuePtr()[k] = values_[source_[k]];
  factor_.factorize(matrix_);
  return factor_.info() == Eigen::Success;
}

void DirectSolver::solve(std::span<double> x, std::span<double> residual, const Excess& /*excess*/,
                         Residual /*kind*/) {
  std::fill(residual.begin(), residual.end(), 0.0);
  Eigen::Map<Eigen::VectorXd> right(x.data(), static_cast<Eigen::Index>(x.size()));
  right = factor_.solve(right).eval();
}

}  // namespace

std::unique_ptr<BlockSolver> make_direct() {
  return std::make_unique<DirectSolver>();
}

}  // namespace keyblock::linalg
