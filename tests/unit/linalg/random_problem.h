#pragma once
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <memory>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "linalg/block_solver.h"

namespace keyblock::linalg {

struct Problem {
  std::vector<int> sizes;
  std::vector<std::pair<int, int>> pairs;
  Eigen::MatrixXd dense;
  Eigen::VectorXd right;
};

/// A random positive definite matrix with the given block sizes on a random graph.
inline Problem random_problem(unsigned seed, int n, const std::vector<int>& choice) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Problem p;
  std::vector<int> start{0};
  for (int i = 0; i < n; ++i) {
    p.sizes.push_back(choice[random() % choice.size()]);
    start.push_back(start.back() + p.sizes.back());
  }
  std::set<std::pair<int, int>> pairs;
  for (int k = 0; k < 3 * n; ++k) {
    const int i = static_cast<int>(random() % static_cast<unsigned>(n)),
              j = static_cast<int>(random() % static_cast<unsigned>(n));
    if (i < j) pairs.insert({i, j});
  }
  p.pairs.assign(pairs.begin(), pairs.end());
  for (std::size_t k = 0; k < p.pairs.size(); k += 2) std::swap(p.pairs[k].first, p.pairs[k].second);
  p.dense = Eigen::MatrixXd::Zero(start.back(), start.back());
  const auto fill = [&](int i, int j) {
    for (int r = start[static_cast<std::size_t>(i)]; r < start[static_cast<std::size_t>(i) + 1]; ++r) {
      for (int c = start[static_cast<std::size_t>(j)]; c < start[static_cast<std::size_t>(j) + 1]; ++c) {
        p.dense(r, c) = p.dense(c, r) = uniform(random);
      }
    }
  };
  for (int i = 0; i < n; ++i) fill(i, i);
  for (const auto& [i, j] : p.pairs) fill(i, j);
  for (Eigen::Index r = 0; r < p.dense.rows(); ++r) p.dense(r, r) = 1.0 + p.dense.row(r).cwiseAbs().sum();
  p.right = Eigen::VectorXd::NullaryExpr(start.back(), [&] { return uniform(random); });
  return p;
}

inline BlockSolver::Excess strict() {
  return [](std::span<const double> residual) {
    double largest = 0.0;
    for (const double r : residual) largest = std::max(largest, std::abs(r));
    return largest / 1e-13;
  };
}

inline void fill(BlockSolver& solver, const Problem& p) {
  std::vector<int> start{0};
  for (const int size : p.sizes) start.push_back(start.back() + size);
  const auto first = [&](int i) { return start[static_cast<std::size_t>(i)]; };
  const auto size = [&](int i) { return p.sizes[static_cast<std::size_t>(i)]; };
  solver.clear();
  for (int i = 0; i < static_cast<int>(p.sizes.size()); ++i) {
    for (int c = 0; c < size(i); ++c) {
      for (int r = c; r < size(i); ++r)
        solver.diagonal(i)[c * padded_rows(size(i)) + r] += p.dense(first(i) + r, first(i) + c);
    }
  }
  for (int k = 0; k < static_cast<int>(p.pairs.size()); ++k) {
    const BlockSlot slot = solver.slot(k);
    for (int c = 0; c < size(slot.column); ++c) {
      for (int r = 0; r < size(slot.row); ++r) {
        slot.values[c * slot.stride + r] += p.dense(first(slot.row) + r, first(slot.column) + c);
      }
    }
  }
}

inline Eigen::VectorXd solve(BlockSolver& solver, const Problem& p) {
  fill(solver, p);
  EXPECT_TRUE(solver.factor());
  std::vector<double> x(p.right.data(), p.right.data() + p.right.size());
  std::vector<double> residual(x.size());
  solver.solve(x, residual, strict());
  return Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

inline std::unique_ptr<BlockSolver> make_iterative() {
  return make_block_conjugate_residual(nullptr);
}

}  // namespace keyblock::linalg
