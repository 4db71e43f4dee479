#include "linalg/block_cholesky.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include "core/index.h"
#include "linalg/numbers.h"
#include "linalg/registers.h"

namespace keyblock::linalg {

namespace {

/// Numbers of the columns that two paths have in common: all from where they meet.
std::size_t shared_size(const BlockPattern& pattern, const ForwardVector& x, const ForwardVector& y) {
  const std::size_t most = std::min(x.path.size(), y.path.size());
  std::size_t depth = 0;
  constexpr std::size_t some = 8;
  while (depth + some <= most && std::memcmp(&x.path[depth], &y.path[depth], some * sizeof(x.path[0])) == 0)
    depth += some;
  while (depth < most && x.path[depth] == y.path[depth]) ++depth;
  if (depth == 0) return 0;
  const std::size_t last = x.path[depth - 1];
  return pattern.above[last] + at(pattern.stride[last]);
}

}  // namespace

void BlockCholesky::analyse(std::span<const int> sizes, std::span<const std::pair<int, int>> pairs) {
  pattern_ = BlockPattern(sizes, pairs);
  matrix_ = BlockMatrix(pattern_, pairs);
  single_.reset();
  double_.reset();
  const bool is_worth_it =
      pattern_.values >= numbers::worth_single &&
      std::ranges::all_of(sizes, [](int size) { return size <= numbers::largest_single_block; });
  if (precision_ == Precision::single || (precision_ == Precision::automatic && is_worth_it))
    single_.emplace(pattern_);
  in_double_ = !single_;
  share_left_ = 0.0;
  work_.assign(pattern_.work_size, 0.0);
  right_.assign(pattern_.work_size, 0.0);
  solution_.assign(pattern_.work_size, 0.0);
}

void BlockCholesky::clear() {
  matrix_.clear();
  if (single_) single_->make_stale();
  if (double_) double_->make_stale();
  in_double_ = !single_;
  share_left_ = 0.0;
}

/// Calls call(factor) with the factor at hand.
template <typename Call>
void BlockCholesky::with_factor(const Call& call) {
  if (in_double_) {
    call(*double_);
  } else {
    call(*single_);
  }
}

void BlockCholesky::touch(int block) {
  if (in_double_) {
    if (double_) double_->make_stale(column(block));
  } else {
    single_->make_stale(column(block));
  }
}

bool BlockCholesky::factor_in_double() {
  if (!double_) double_.emplace(pattern_);
  in_double_ = true;
  return double_->factor(pattern_, matrix_, 0.0) == FactorOutcome::done;
}

bool BlockCholesky::factor() {
  solved_ = true;
  if (!in_double_) {
    if (single_->factor(pattern_, matrix_, numbers::least_single_pivot) == FactorOutcome::done) return true;
    if (double_) double_->make_stale();
  }
  return factor_in_double();
}

/// Brings x into the order of elimination.
void BlockCholesky::to_columns(std::span<const double> x, std::span<double> by_column) const {
  for (std::size_t j = 0; j < pattern_.columns(); ++j)
    std::copy_n(&x[pattern_.offset[j]], pattern_.size[j], &by_column[pattern_.work_start[j]]);
}

void BlockCholesky::from_columns(std::span<const double> by_column, std::span<double> x) const {
  for (std::size_t j = 0; j < pattern_.columns(); ++j)
    std::copy_n(&by_column[pattern_.work_start[j]], pattern_.size[j], &x[pattern_.offset[j]]);
}

void BlockCholesky::solve_by_column(std::span<double> x) {
  with_factor([&](auto& factor) {
    factor.forward(pattern_, x);
    factor.backward(pattern_, x);
  });
}

/// Solutions in single precision, each of what the ones before left over. Whether the excess came down to 1.
bool BlockCholesky::refine(std::span<double> x, std::span<double> residual, const Excess& excess,
                           Residual kind) {
  double left = excess(x);
  std::fill(solution_.begin(), solution_.end(), 0.0);
  work_ = right_;
  for (int round = 0; round < numbers::most_refinements; ++round) {
    solve_by_column(work_);
    for (std::size_t k = 0; k < work_.size(); ++k) solution_[k] += work_[k];
    if (kind == Residual::estimated && share_left_ > 0.0 && share_left_ * left < numbers::sure_excess) {
      std::fill(residual.begin(), residual.end(), 0.0);
      from_columns(solution_, x);
      return true;
    }
    work_ = right_;
    matrix_.subtract_product(pattern_, solution_, work_);
    from_columns(work_, residual);
    const double now = excess(residual);
    if (left > 0.0) share_left_ = std::max(share_left_, now / left);
    left = now;
    if (left > 1.0) continue;
    from_columns(solution_, x);
    return true;
  }
  return false;
}

void BlockCholesky::solve(std::span<double> x, std::span<double> residual, const Excess& excess,
                          Residual kind) {
  to_columns(x, right_);
  if (!in_double_) {
    if (refine(x, residual, excess, kind)) return;
    if (double_) double_->make_stale();
    solved_ = factor_in_double();
    if (!solved_) return;
  }
  std::fill(residual.begin(), residual.end(), 0.0);
  solve_by_column(right_);
  from_columns(right_, x);
}

/// v, at the columns on its path.
void BlockCholesky::begin_path(const PairVector& v, ForwardVector& w) const {
  std::size_t first = BlockPattern::none;
  for (const Part& part : {v.a, v.b}) {
    if (part.block >= 0) first = std::min(first, column(part.block));
  }
  w.column = static_cast<int>(first);
  w.values.assign(pattern_.above[first] + at(pattern_.stride[first]), 0.0);
  for (const Part& part : {v.a, v.b}) {
    if (part.block >= 0)
      std::copy(part.values.begin(), part.values.end(), &w.values[pattern_.above[column(part.block)]]);
  }
  w.path.clear();
  for (std::size_t j = first; j != BlockPattern::none; j = pattern_.parent[j])
    w.path.push_back(static_cast<std::uint32_t>(j));
  std::ranges::reverse(w.path);
}

void BlockCholesky::forward_solve(std::span<const PairVector> vs, std::span<ForwardVector> ws) {
  for (std::size_t k = 0; k < vs.size(); ++k) begin_path(vs[k], ws[k]);
  with_factor([&](auto& factor) {
    for (std::size_t k = 0; k < ws.size(); k += numbers::forward_group)
      factor.forward(pattern_, ws.subspan(k, std::min(numbers::forward_group, ws.size() - k)));
  });
}

double BlockCholesky::product(const ForwardVector& x, const ForwardVector& y) const {
  double product = 0.0;
  find_products(x, {&y, 1}, {&product, 1});
  return product;
}

void BlockCholesky::find_products(const ForwardVector& x, std::span<const ForwardVector> ys,
                                  std::span<double> products) const {
  std::size_t shared = 0;
  for (std::size_t k = 0; k < ys.size();) {
    // Those of the same column have the same path.
    if (k == 0 || ys[k].column != ys[k - 1].column) shared = shared_size(pattern_, x, ys[k]);
    const bool two = k + 1 < ys.size() && ys[k + 1].column == ys[k].column;
    const double *y = ys[k].values.data(), *other = ys[two ? k + 1 : k].values.data();
    Lanes t{}, s{};
    for (std::size_t l = 0; l < shared; l += row_padding) {
      add_lane_product(&x.values[l], y + l, t);
      add_lane_product(&x.values[l], other + l, s);
    }
    products[k++] = sum(t);
    if (two) products[k++] = sum(s);
  }
}

double BlockCholesky::product(const ForwardVector& x, std::span<const double> y) const {
  Lanes t{};
  for (std::size_t j = at(x.column); j != BlockPattern::none; j = pattern_.parent[j]) {
    for (std::size_t l = 0; l < at(pattern_.stride[j]); l += row_padding)
      add_lane_product(&x.values[pattern_.above[j] + l], &y[pattern_.work_start[j] + l], t);
  }
  return sum(t);
}

void BlockCholesky::forward_solve(std::span<const double> b, std::vector<double>& w) {
  w.resize(pattern_.work_size);
  to_columns(b, w);
  with_factor([&](auto& factor) { factor.forward(pattern_, w); });
}

void BlockCholesky::backward_solve(std::span<const double> w, std::span<const ForwardVector> ws,
                                   std::span<const double> factor, std::span<double> x) {
  std::copy(w.begin(), w.end(), work_.begin());
  for (std::size_t k = 0; k < ws.size(); ++k) {
    for (std::size_t j = at(ws[k].column); j != BlockPattern::none; j = pattern_.parent[j]) {
      double* y = &work_[pattern_.work_start[j]];
      for (int l = 0; l < pattern_.stride[j]; l += row_padding)
        store(y + l,
              add_product(broadcast(factor[k]), load(&ws[k].values[pattern_.above[j] + at(l)]), load(y + l)));
    }
  }
  with_factor([&](auto& of) { of.backward(pattern_, work_); });
  from_columns(work_, x);
}

std::unique_ptr<BlockSolver> make_block_cholesky(Precision precision) {
  return std::make_unique<BlockCholesky>(precision);
}

}  // namespace keyblock::linalg
