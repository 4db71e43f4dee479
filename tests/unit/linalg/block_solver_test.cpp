#include "linalg/block_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>
#include <random>
#include <set>

#include "linalg/dense_block.h"
#include "linalg/partition.h"

namespace keyblock::linalg {
namespace {

struct Problem {
  std::vector<int> sizes;
  std::vector<std::pair<int, int>> pairs;
  Eigen::MatrixXd dense;
  Eigen::VectorXd right;
};

/// A random positive definite matrix with the given block sizes on a random graph.
Problem random_problem(unsigned seed, int n, const std::vector<int>& choice) {
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

BlockSolver::Excess strict() {
  return [](std::span<const double> residual) {
    double largest = 0.0;
    for (const double r : residual) largest = std::max(largest, std::abs(r));
    return largest / 1e-13;
  };
}

Eigen::VectorXd solve(BlockSolver& solver, const Problem& p) {
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
  EXPECT_TRUE(solver.factor());
  std::vector<double> x(p.right.data(), p.right.data() + p.right.size());
  std::vector<double> residual(x.size());
  solver.solve(x, residual, strict());
  return Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

std::unique_ptr<BlockSolver> make_iterative() {
  return make_block_conjugate_gradient(nullptr);
}

// What an iterative solver leaves is what it says; without a look at the matrix, but for what single precision leaves.
TEST(BlockSolver, ResidualIsWhatIsMissing) {
  const Problem p = random_problem(5, 30, {6, 12});
  const auto solver = make_iterative();
  solver->analyse(p.sizes, p.pairs);
  solve(*solver, p);
  const auto norm = [](std::span<const double> r) {
    double sum = 0.0;
    for (const double v : r) sum += v * v;
    return std::sqrt(sum);
  };
  const auto error_of = [&](BlockSolver::Residual kind) {
    std::vector<double> x(p.right.data(), p.right.data() + p.right.size()), residual(x.size());
    solver->solve(
        x, residual, [&](std::span<const double> r) { return norm(r) / 0.01; }, kind);
    EXPECT_TRUE(solver->solved());
    EXPECT_LE(norm(residual), 0.01);
    EXPECT_GT(norm(residual), 1e-9);
    const Eigen::VectorXd missing =
        p.right - p.dense * Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
    return (Eigen::Map<Eigen::VectorXd>(residual.data(), missing.size()) - missing).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(error_of(BlockSolver::Residual::exact), 1e-12);
  const double estimated = error_of(BlockSolver::Residual::estimated);
  EXPECT_GT(estimated, 1e-12);  // it is an estimate
  EXPECT_LT(estimated, 1e-5);
}

// A solution that is not good enough after all goes on from where it ended, as if nothing had been in between.
TEST(BlockSolver, SolutionsGoOnWhereTheyEnded) {
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12}}) {
    const Problem p = random_problem(5, 30, choice);
    const auto solver = make_iterative();
    solver->analyse(p.sizes, p.pairs);
    const auto exact = solve(*solver, p);
    for (const auto kind : {BlockSolver::Residual::exact, BlockSolver::Residual::estimated}) {
      std::vector<double> x(p.right.data(), p.right.data() + p.right.size()), residual(x.size());
      int looks = 0;
      const auto error = [&] {
        double largest = 0.0;
        for (std::size_t k = 0; k < x.size(); ++k)
          largest = std::max(largest, std::abs(x[k] - exact[static_cast<Eigen::Index>(k)]));
        return largest;
      };
      const auto excess_over = [&](double enough) {
        return [&looks, enough](std::span<const double> r) {
          ++looks;
          double largest = 0.0;
          for (const double v : r) largest = std::max(largest, std::abs(v));
          return largest / enough;
        };
      };
      solver->solve(x, residual, excess_over(1e9), kind);
      EXPECT_TRUE(std::ranges::all_of(x, [](double v) { return v == 0.0; })) << "good enough as it is";
      solver->improve(x, residual, excess_over(1e-2), kind);
      const double roughly = error();
      EXPECT_GT(roughly, 1e-6);
      solver->improve(x, residual, excess_over(1e-5), kind);
      EXPECT_TRUE(solver->solved());
      EXPECT_LT(error(), 1e-2 * roughly);
      looks = 0;
      solver->improve(x, residual, excess_over(1.0), kind);
      EXPECT_EQ(looks, 1) << "nothing to do";
    }
  }
}

// What is factored in part is, bit for bit, what is factored as a whole.
TEST(BlockSolver, FactorsWhatWasTouchedOnly) {
  for (const auto& make : {make_block_cholesky, make_cholmod, make_iterative}) {
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
      for (const auto& make : {make_block_cholesky, make_cholmod, make_iterative}) {
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
TEST(BlockSolver, HalvesAreThoseOfTheSolutions) {
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
      const auto solver = make_block_cholesky();
      solver->analyse(p.sizes, p.pairs);
      solve(*solver, p);
      HalfSolver& halves = *solver->halves();
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-1.0, 1.0);
      std::vector<HalfSolution> half;
      Eigen::MatrixXd vectors = Eigen::MatrixXd::Zero(p.dense.rows(), 12);
      std::vector<double> factor;
      for (int k = 0; k < 12; ++k) {
        const auto [i, j] = p.pairs[random() % p.pairs.size()];
        std::vector<double> values[2];
        for (int side = 0; side < (k % 3 == 0 ? 1 : 2); ++side) {
          const int block = side == 0 ? i : j;
          const int first = std::accumulate(p.sizes.begin(), p.sizes.begin() + block, 0);
          for (int u = 0; u < p.sizes[static_cast<std::size_t>(block)]; ++u) {
            values[side].push_back(uniform(random));
            vectors(first + u, k) = values[side].back();
          }
        }
        half.emplace_back();
        halves.half_solve({i, values[0]}, {values[1].empty() ? -1 : j, values[1]}, half.back());
        factor.push_back(uniform(random));
      }
      const Eigen::MatrixXd solved = p.dense.ldlt().solve(vectors), product = vectors.transpose() * solved;
      for (std::size_t k = 0; k < half.size(); ++k) {
        for (std::size_t l = 0; l < half.size(); ++l)
          EXPECT_NEAR(halves.product(half[k], half[l]),
                      product(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)), 1e-14);
      }
      const Eigen::VectorXd whole =
          Eigen::VectorXd::NullaryExpr(p.dense.rows(), [&] { return uniform(random); });
      const Eigen::VectorXd whole_solved = p.dense.ldlt().solve(whole);
      std::vector<double> whole_half;
      halves.half_solve(std::span(whole.data(), static_cast<std::size_t>(whole.size())), whole_half);
      for (std::size_t k = 0; k < half.size(); ++k)
        EXPECT_NEAR(halves.product(half[k], whole_half), whole.dot(solved.col(static_cast<Eigen::Index>(k))),
                    1e-14);
      std::vector<double> x(static_cast<std::size_t>(p.dense.rows()));
      halves.finish(whole_half, half, factor, x);
      const Eigen::VectorXd expected = whole_solved + solved * Eigen::Map<Eigen::VectorXd>(factor.data(), 12);
      for (std::size_t k = 0; k < x.size(); ++k)
        EXPECT_NEAR(x[k], expected[static_cast<Eigen::Index>(k)], 1e-14);
    }
  }
}

TEST(BlockSolver, SaysWhenAMatrixIsNotPositiveDefinite) {
  for (const auto& make : {make_block_cholesky, make_cholmod}) {
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

// Enough blocks to be cut into parts: a grid with diagonals here and there, and a piece that is not coupled with it.
struct Grid {
  static constexpr int side = 50, blocks = side * side + 40;
  std::vector<std::pair<int, int>> pairs;
  Grid() {
    std::mt19937 random(3);
    for (int k = 0; k < side * side; ++k) {
      if (k % side != 0) pairs.emplace_back(k - 1, k);
      if (k >= side) pairs.emplace_back(k, k - side);
      if (k > side && k % side != 0 && random() % 5 == 0) pairs.emplace_back(k - side - 1, k);
    }
    for (int k = side * side + 1; k < blocks; ++k) pairs.emplace_back(k - 1, k);
  }
};

TEST(Partition, PartsAreSmallAndNotCoupled) {
  const Grid grid;
  const Partition found = partition(Grid::blocks, grid.pairs);
  std::vector<int> sorted = found.order;
  std::sort(sorted.begin(), sorted.end());
  for (int k = 0; k < Grid::blocks; ++k) ASSERT_EQ(sorted[static_cast<std::size_t>(k)], k);
  ASSERT_EQ(found.begin.front(), 0U);
  ASSERT_EQ(found.begin.back(), sorted.size());
  EXPECT_LT(found.begin[1], sorted.size() / 10);
  std::vector<std::size_t> part(sorted.size());
  for (std::size_t p = 0; p + 1 < found.begin.size(); ++p) {
    EXPECT_LE(found.begin[p + 1] - found.begin[p], 1'000U);
    for (std::size_t k = found.begin[p]; k < found.begin[p + 1]; ++k)
      part[static_cast<std::size_t>(found.order[k])] = p;
  }
  for (const auto& [i, j] : grid.pairs) {
    const std::size_t a = part[static_cast<std::size_t>(i)], b = part[static_cast<std::size_t>(j)];
    EXPECT_TRUE(a == b || a == 0 || b == 0) << i << ' ' << j;
  }
}

// A slab on thousands of stones: most blocks are of the last level, beyond which there is none to cut off.
TEST(Partition, EndsWhereOneBlockTouchesAll) {
  constexpr int blocks = 3'000;
  std::vector<std::pair<int, int>> pairs;
  for (int k = 1; k < blocks; ++k) pairs.emplace_back(0, k);
  const Partition found = partition(blocks, pairs);
  EXPECT_EQ(found.order.size(), static_cast<std::size_t>(blocks));
  EXPECT_EQ(found.order.front(), 0);
  EXPECT_EQ(found.begin[1], 1U);
  for (std::size_t p = 1; p + 1 < found.begin.size(); ++p)
    EXPECT_LE(found.begin[p + 1] - found.begin[p], 1'000U);
}

/// A system on that grid, of blocks of some of these sizes.
struct GridProblem {
  Grid grid;
  std::vector<int> sizes;
  std::vector<double> right;
  std::vector<std::vector<double>> coupling;  ///< by rows of the first block of the pair
  std::vector<double> diagonal;

  explicit GridProblem(const std::vector<int>& choice) : diagonal(Grid::blocks, 4.0 * choice.back()) {
    std::mt19937 random(5);
    for (int b = 0; b < Grid::blocks; ++b) sizes.push_back(choice[random() % choice.size()]);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    right.resize(static_cast<std::size_t>(std::accumulate(sizes.begin(), sizes.end(), 0)));
    for (double& v : right) v = uniform(random);
    for (const auto& [i, j] : grid.pairs) {
      coupling.emplace_back(static_cast<std::size_t>(size_of(i) * size_of(j)));
      for (double& v : coupling.back()) v = uniform(random);
    }
  }
  [[nodiscard]] int size_of(int block) const { return sizes[static_cast<std::size_t>(block)]; }

  void fill(BlockSolver& solver, std::size_t pair) const {
    const BlockSlot slot = solver.slot(static_cast<int>(pair));
    const auto [i, j] = grid.pairs[pair];
    for (int r = 0; r < size_of(i); ++r) {
      for (int c = 0; c < size_of(j); ++c) {
        const bool turned = slot.row != i;
        slot.values[turned ? r * slot.stride + c : c * slot.stride + r] =
            coupling[pair][static_cast<std::size_t>(r * size_of(j) + c)];
      }
    }
  }
  void fill_diagonal(BlockSolver& solver, int block) const {
    const int size = size_of(block);
    for (int k = 0; k < size; ++k)
      solver.diagonal(block)[k * padded_rows(size) + k] = diagonal[static_cast<std::size_t>(block)];
  }
  void fill(BlockSolver& solver) const {
    solver.analyse(sizes, grid.pairs);
    solver.clear();
    for (int b = 0; b < Grid::blocks; ++b) fill_diagonal(solver, b);
    for (std::size_t k = 0; k < grid.pairs.size(); ++k) fill(solver, k);
  }
  [[nodiscard]] std::vector<double> factor_and_solve(BlockSolver& solver) const {
    EXPECT_TRUE(solver.factor());
    std::vector<double> x = right, residual(x.size());
    solver.solve(x, residual, strict());
    return x;
  }
  [[nodiscard]] std::vector<double> solution(BlockSolver& solver) const {
    fill(solver);
    return factor_and_solve(solver);
  }
};

TEST(BlockSolver, PartsGiveTheSameBitsForAnyNumberOfThreads) {
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12, 20}}) {
    const GridProblem problem(choice);
    const auto expected = problem.solution(*make_block_cholesky()),
               alone = problem.solution(*make_iterative());
    for (std::size_t k = 0; k < alone.size(); ++k) EXPECT_NEAR(alone[k], expected[k], 1e-10);
    for (const int threads : {2, 3, 8}) {
      ThreadTeam team(threads);
      EXPECT_EQ(problem.solution(*make_block_conjugate_gradient(&team)), alone) << threads;
    }
  }
}

// Also where the one block lies between the parts, whose rows are kept twice.
TEST(BlockSolver, PartsAreFactoredWhereTouchedOnly) {
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12, 20}}) {
    GridProblem problem(choice);
    const auto solver = make_iterative();
    const auto before = problem.solution(*solver);
    const Partition found = partition(Grid::blocks, problem.grid.pairs);
    std::vector<bool> between(Grid::blocks, false);
    for (std::size_t k = 0; k < found.begin[1]; ++k) between[static_cast<std::size_t>(found.order[k])] = true;
    int changed = 0;
    for (std::size_t k = 0; k < problem.grid.pairs.size(); ++k) {
      const auto [i, j] = problem.grid.pairs[k];
      if (between[static_cast<std::size_t>(i)] == between[static_cast<std::size_t>(j)]) continue;
      ++changed;
      if (changed % 7 == 0) {
        problem.coupling[k].front() += 0.125;
        problem.fill(*solver, k);
        solver->touch(i);
        solver->touch(j);
      } else if (changed % 7 == 3) {
        const int in_part = between[static_cast<std::size_t>(i)] ? j : i;
        problem.diagonal[static_cast<std::size_t>(in_part)] += 0.125;
        problem.fill_diagonal(*solver, in_part);
        solver->touch(in_part);
      }
    }
    EXPECT_GT(changed, 100);
    const auto after = problem.factor_and_solve(*solver);
    EXPECT_NE(after, before);
    EXPECT_EQ(after, problem.solution(*make_iterative()));
  }
}

}  // namespace
}  // namespace keyblock::linalg
