#include <cholmod.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "linalg/block_solver.h"

namespace keyblock::linalg {

namespace {

class Cholmod final : public BlockSolver {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.final_ll = 1;
    common_.print = 0;
  }
  ~Cholmod() override {
    release();
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  void analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) override;
  void clear() override { std::fill(values_.begin(), values_.end(), 0.0); }
  double* diagonal(int block) override { return &values_[diagonal_[static_cast<std::size_t>(block)]]; }
  BlockSlot slot(int pair) override { return slots_[static_cast<std::size_t>(pair)]; }
  void touch(int) override {}
  bool factor() override;
  void solve(std::span<double> x, std::span<double> residual, const Excess& excess, Residual kind) override;

 private:
  void release() {
    cholmod_free_factor(&factor_, &common_);
    cholmod_free_sparse(&matrix_, &common_);
  }

  cholmod_common common_{};
  cholmod_sparse* matrix_ = nullptr;
  cholmod_factor* factor_ = nullptr;
  std::vector<double> values_;  ///< the blocks as the caller adds to them
  std::vector<std::size_t> diagonal_;
  std::vector<BlockSlot> slots_;
  std::vector<std::size_t> source_;  ///< entry of the compressed matrix → index into values_
};

void Cholmod::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  release();
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

  matrix_ =
      cholmod_allocate_sparse(at(start[n]), at(start[n]), entries.size(), 1, 1, -1, CHOLMOD_REAL, &common_);
  if (matrix_ == nullptr) throw std::bad_alloc();
  auto* column_start = static_cast<int*>(matrix_->p);
  auto* row_index = static_cast<int*>(matrix_->i);
  std::fill(column_start, column_start + start[n] + 1, 0);
  source_.clear();
  for (const auto& [where, from] : entries) {
    row_index[source_.size()] = where.second;
    source_.push_back(from);
    column_start[where.first + 1] = static_cast<int>(source_.size());
  }
  for (int c = 0; c < start[n]; ++c) column_start[c + 1] = std::max(column_start[c + 1], column_start[c]);
  factor_ = cholmod_analyze(matrix_, &common_);
}

bool Cholmod::factor() {
  auto* x = static_cast<double*>(matrix_->x);
  for (std::size_t k = 0; k < source_.size(); ++k) x[k] = values_[source_[k]];
  cholmod_factorize(matrix_, factor_, &common_);
  return common_.status == CHOLMOD_OK;
}

void Cholmod::solve(std::span<double> x, std::span<double> residual, const Excess& /*excess*/,
                    Residual /*kind*/) {
  std::fill(residual.begin(), residual.end(), 0.0);
  cholmod_dense* right = cholmod_allocate_dense(x.size(), 1, x.size(), CHOLMOD_REAL, &common_);
  std::copy(x.begin(), x.end(), static_cast<double*>(right->x));
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, right, &common_);
  std::copy_n(static_cast<double*>(solution->x), x.size(), x.begin());
  cholmod_free_dense(&right, &common_);
  cholmod_free_dense(&solution, &common_);
}

}  // namespace

std::unique_ptr<BlockSolver> make_cholmod() {
  return std::make_unique<Cholmod>();
}

}  // namespace keyblock::linalg
