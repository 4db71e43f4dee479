#include "linalg/block_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>
#include <random>

#include "linalg/dense_block.h"
#include "random_problem.h"

namespace keyblock::linalg {
namespace {

std::unique_ptr<BlockSolver> make_full() {
  return make_block_cholesky(Precision::full);
}
std::unique_ptr<BlockSolver> make_single() {
  return make_block_cholesky(Precision::single);
}
// What is factored in part is, bit for bit, what is factored as a whole.
TEST(BlockSolver, FactorsWhatWasTouchedOnly) {
  for (const auto& make : {make_full, make_single, make_direct, make_iterative}) {
    Problem p = random_problem(77, 40, {6, 12, 20});
    const auto solver = make(), whole = make();
    solver->analyse(p.sizes, p.pairs);
    whole->analyse(p.sizes, p.pairs);
    solve(*solver, p);
    std::vector<int> start{0};
    for (const int size : p.sizes) start.push_back(start.back() + size);
    for (const std::size_t k : {std::size_t{3}, std::size_t{20}, p.pairs.size() - 1}) {
      const BlockSlot slot = solver->slot(static_cast<int>(k));
      slot.values[1] += 0.125;  // row 1, column 0
      const int row = start[static_cast<std::size_t>(slot.row)] + 1,
                column = start[static_cast<std::size_t>(slot.column)];
      p.dense(row, column) += 0.125;
      p.dense(column, row) += 0.125;
      solver->touch(slot.row);
      solver->touch(slot.column);
      ASSERT_TRUE(solver->factor());
      std::vector<double> x(p.right.data(), p.right.data() + p.right.size());
      std::vector<double> residual(x.size());
      solver->solve(x, residual, strict());
      const Eigen::VectorXd expected = solve(*whole, p);
      for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(x[i], expected[static_cast<Eigen::Index>(i)]);
    }
  }
}

TEST(BlockSolver, AgreesWithDenseSolutionForEqualAndMixedBlocks) {
  unsigned seed = 0;
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12}, {12}, {6, 12, 20, 30}, {72}, {132}}) {
    for (int n : {1, 2, 7, 40}) {
      if (choice[0] >= 72 && n > 7) continue;
      const Problem p = random_problem(++seed, n, choice);
      const Eigen::VectorXd expected = p.dense.ldlt().solve(p.right);
      for (const auto& make : {make_full, make_single, make_direct, make_iterative}) {
        const auto solver = make();
        solver->analyse(p.sizes, p.pairs);
        for (int repeat = 0; repeat < 2; ++repeat) {
          EXPECT_LT((solve(*solver, p) - expected).norm() / expected.norm(), 1e-12) << n << ' ' << choice[0];
        }
      }
    }
  }
}

TEST(DenseBlock, IsSolved) {
  for (const int n : {6, 12, 20}) {
    const Problem p = random_problem(static_cast<unsigned>(n), 1, {n});
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(n, -1.0, 2.0);
    const Eigen::VectorXd expected = p.dense.ldlt().solve(right);
    std::vector<double> a(static_cast<std::size_t>(padded_rows(n) * n)), x(right.data(), right.data() + n);
    for (int c = 0; c < n; ++c) {
      for (int r = c; r < n; ++r) a[static_cast<std::size_t>(c * padded_rows(n) + r)] = p.dense(r, c);
    }
    ASSERT_TRUE(solve_block(n, a.data(), x.data()));
    for (int k = 0; k < n; ++k) EXPECT_NEAR(x[static_cast<std::size_t>(k)], expected[k], 1e-14);
    a[0] = -1.0;
    EXPECT_FALSE(solve_block(n, a.data(), x.data()));
  }
}

// Halves of solutions multiply to aᵀ A⁻¹ b, and are finished to A⁻¹ b, for vectors of one block, of two with a pair, and of all.
void expect_forward_vectors_of_solutions(std::unique_ptr<BlockSolver> (*make)(), bool exact, double error) {
  unsigned seed = 40;
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12}, {12}, {6, 12, 20, 30}}) {
    // Few pairs leave parts that nothing couples.
    for (const std::size_t pairs : {std::size_t{8}, std::size_t{60}}) {
      Problem p = random_problem(++seed, 25, choice);
      for (std::size_t k = pairs; k < p.pairs.size(); ++k) {
        const auto range = [&](int i) {
          const int first = std::accumulate(p.sizes.begin(), p.sizes.begin() + i, 0);
          return Eigen::seqN(first, p.sizes[static_cast<std::size_t>(i)]);
        };
        p.dense(range(p.pairs[k].first), range(p.pairs[k].second)).setZero();
        p.dense(range(p.pairs[k].second), range(p.pairs[k].first)).setZero();
      }
      if (pairs < p.pairs.size()) p.pairs.resize(pairs);
      const auto solver = make();
      solver->analyse(p.sizes, p.pairs);
      solve(*solver, p);
      LowRankSolver& low_rank = *solver->low_rank();
      ASSERT_EQ(low_rank.is_exact(), exact);
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-1.0, 1.0);
      std::vector<std::array<std::vector<double>, 2>> parts(12);
      std::vector<LowRankSolver::PairVector> pair_vectors;
      Eigen::MatrixXd vectors = Eigen::MatrixXd::Zero(p.dense.rows(), 12);
      std::vector<double> factor;
      for (int k = 0; k < 12; ++k) {
        const auto [i, j] = p.pairs[random() % p.pairs.size()];
        std::array<std::vector<double>, 2>& values = parts[static_cast<std::size_t>(k)];
        for (std::size_t side = 0; side < (k % 3 == 0 ? 1U : 2U); ++side) {
          const int block = side == 0 ? i : j;
          const int first = std::accumulate(p.sizes.begin(), p.sizes.begin() + block, 0);
          for (int u = 0; u < p.sizes[static_cast<std::size_t>(block)]; ++u) {
            values[side].push_back(uniform(random));
            vectors(first + u, k) = values[side].back();
          }
        }
        pair_vectors.push_back({{i, values[0]}, {values[1].empty() ? -1 : j, values[1]}});
        factor.push_back(uniform(random));
      }
      std::vector<ForwardVector> forward(pair_vectors.size());
      low_rank.forward_solve(pair_vectors, forward);
      for (std::size_t k = 0; k < forward.size(); ++k) {
        ForwardVector alone;
        low_rank.forward_solve({&pair_vectors[k], 1}, {&alone, 1});
        EXPECT_EQ(forward[k].values, alone.values);
        std::vector<double> products(forward.size());
        low_rank.find_products(alone, forward, products);
        for (std::size_t l = 0; l < forward.size(); ++l)
          EXPECT_EQ(products[l], low_rank.product(forward[l], alone));
      }
      const Eigen::MatrixXd solved = p.dense.ldlt().solve(vectors), product = vectors.transpose() * solved;
      for (std::size_t k = 0; k < forward.size(); ++k) {
        for (std::size_t l = 0; l < forward.size(); ++l)
          EXPECT_NEAR(low_rank.product(forward[k], forward[l]),
                      product(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)), error);
      }
      const Eigen::VectorXd whole =
          Eigen::VectorXd::NullaryExpr(p.dense.rows(), [&] { return uniform(random); });
      const Eigen::VectorXd whole_solved = p.dense.ldlt().solve(whole);
      std::vector<double> whole_forward;
      low_rank.forward_solve(std::span(whole.data(), static_cast<std::size_t>(whole.size())), whole_forward);
      for (std::size_t k = 0; k < forward.size(); ++k)
        EXPECT_NEAR(low_rank.product(forward[k], whole_forward),
                    whole.dot(solved.col(static_cast<Eigen::Index>(k))), error);
      std::vector<double> x(static_cast<std::size_t>(p.dense.rows()));
      low_rank.backward_solve(whole_forward, forward, factor, x);
      const Eigen::VectorXd expected = whole_solved + solved * Eigen::Map<Eigen::VectorXd>(factor.data(), 12);
      for (std::size_t k = 0; k < x.size(); ++k)
        EXPECT_NEAR(x[k], expected[static_cast<Eigen::Index>(k)], error);
    }
  }
}

TEST(BlockSolver, ForwardVectorsAreThoseOfTheSolutions) {
  expect_forward_vectors_of_solutions(make_full, true, 1e-14);
  expect_forward_vectors_of_solutions(make_single, false, 1e-6);
}

/// Bodies in a row that springs of this stiffness couple, over an inertia of 1.
Problem stiff_chain(double stiffness) {
  constexpr int blocks = 20, size = 6;
  Problem p;
  p.sizes.assign(blocks, size);
  p.dense = Eigen::MatrixXd::Identity(blocks * size, blocks * size);
  for (int k = 0; k + 1 < blocks; ++k) {
    p.pairs.emplace_back(k, k + 1);
    for (int u = 0; u < size; ++u) {
      Eigen::VectorXd stretch = Eigen::VectorXd::Zero(blocks * size);
      stretch[size * k + u] = -1.0;
      stretch[size * (k + 1) + u] = 1.0;
      p.dense += stiffness * stretch * stretch.transpose();
    }
  }
  p.right = Eigen::VectorXd::LinSpaced(blocks * size, -1.0, 2.0);
  return p;
}

// Single precision does where pivots are not the small differences of large numbers; where they are, and where solutions do not come to
// be good enough, the factor is that of double precision, to the bit. A new matrix is tried in single precision again.
TEST(BlockSolver, DoublePrecisionWhereSingleHasTooFewDigits) {
  const auto solver = make_single(), full = make_full();
  for (const double stiffness : {1e2, 1e8, 1e3, 1e12}) {
    const Problem p = stiff_chain(stiffness);
    const bool exact = stiffness > 1e6;
    solver->analyse(p.sizes, p.pairs);
    full->analyse(p.sizes, p.pairs);
    const Eigen::VectorXd expected = solve(*full, p);
    std::vector<double> x, residual(static_cast<std::size_t>(p.right.size()));
    for (int repeat = 0; repeat < 2; ++repeat) {
      fill(*solver, p);
      ASSERT_TRUE(solver->factor());
      EXPECT_EQ(solver->low_rank()->is_exact(), exact) << stiffness;
      x.assign(p.right.begin(), p.right.end());
      solver->solve(x, residual, [&](std::span<const double> r) {
        return std::abs(*std::ranges::max_element(r, {}, [](double v) { return std::abs(v); })) /
               (1e-12 * stiffness);
      });
      EXPECT_TRUE(solver->solved());
      for (std::size_t k = 0; k < x.size(); ++k) {
        const double of_full = expected[static_cast<Eigen::Index>(k)];
        if (exact) {
          EXPECT_EQ(x[k], of_full);
        } else {
          EXPECT_NEAR(x[k], of_full, 1e-9);
        }
      }
    }
    if (exact) continue;
    EXPECT_GT(*std::ranges::max_element(residual), 0.0);  // not those of double precision
    x.assign(p.right.begin(), p.right.end());
    solver->solve(x, residual, [](std::span<const double>) { return 2.0; });
    EXPECT_TRUE(solver->low_rank()->is_exact());
    EXPECT_EQ(Eigen::Map<Eigen::VectorXd>(x.data(), p.right.size()), expected);
  }
}

// What one solution in single precision leaves over is looked at once for a matrix, where an estimate will do.
TEST(BlockSolver, LooksAtWhatSinglePrecisionLeavesOnce) {
  const Problem p = random_problem(9, 30, {6, 12});
  const auto solver = make_single();
  solver->analyse(p.sizes, p.pairs);
  for (int matrix = 0; matrix < 2; ++matrix) {
    fill(*solver, p);
    ASSERT_TRUE(solver->factor());
    for (const auto& [kind, expected] : {std::pair(BlockSolver::Residual::estimated, 2),
                                         {BlockSolver::Residual::estimated, 1},
                                         {BlockSolver::Residual::exact, 2}}) {
      std::vector<double> x(p.right.begin(), p.right.end()), residual(x.size(), 1.0);
      int looks = 0;
      const auto excess = [&](std::span<const double> r) {
        ++looks;
        return std::abs(std::ranges::max(r, {}, [](double v) { return std::abs(v); })) / 1e-4;
      };
      solver->solve(x, residual, excess, kind);
      EXPECT_EQ(looks, expected) << matrix;
      const Eigen::VectorXd missing =
          p.right - p.dense * Eigen::Map<Eigen::VectorXd>(x.data(), p.right.size());
      EXPECT_LT(missing.cwiseAbs().maxCoeff(), 1e-5);
      EXPECT_GT(missing.cwiseAbs().maxCoeff(), 1e-10);  // not in double precision
      if (looks == 1) {
        EXPECT_TRUE(std::ranges::all_of(residual, [](double v) { return v == 0.0; }));
      } else {
        for (std::size_t k = 0; k < residual.size(); ++k)
          EXPECT_NEAR(residual[k], missing[static_cast<Eigen::Index>(k)], 1e-13);
      }
    }
  }
}

TEST(BlockSolver, SaysWhenAMatrixIsNotPositiveDefinite) {
  for (const auto& make : {make_full, make_single, make_direct}) {
    const auto solver = make();
    solver->analyse(std::vector{6}, std::vector<std::pair<int, int>>{});
    solver->clear();
    for (int i = 0; i < 6; ++i) solver->diagonal(0)[i * padded_rows(6) + i] = i == 3 ? -1.0 : 1.0;
    EXPECT_FALSE(solver->factor());
  }
}

TEST(BlockSolver, AnEmptySystemIsSolved) {
  const auto solver = make_block_cholesky();
  solver->analyse(std::vector<int>{}, std::vector<std::pair<int, int>>{});
  EXPECT_TRUE(solver->factor());
  std::vector<double> x;
  std::vector<double> residual(x.size());
  solver->solve(x, residual, [](std::span<const double>) { return 0.0; });
}

}  // namespace
}  // namespace keyblock::linalg
