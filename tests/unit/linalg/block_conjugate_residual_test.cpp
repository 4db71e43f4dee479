#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "linalg/partition.h"
#include "random_problem.h"

namespace keyblock::linalg {
namespace {

// What an iterative solver leaves is what it says; without a look at the matrix, but for what single precision leaves. However many
// iterations it took: solutions go them two at a time.
TEST(BlockSolver, ResidualIsWhatIsMissing) {
  const auto norm = [](std::span<const double> r) {
    double sum = 0.0;
    for (const double v : r) sum += v * v;
    return std::sqrt(sum);
  };
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12}}) {
    const Problem p = random_problem(5, 30, choice);
    const auto solver = make_iterative();
    solver->analyse(p.sizes, p.pairs);
    solve(*solver, p);
    const auto error_of = [&](BlockSolver::Residual kind, double enough) {
      std::vector<double> x(p.right.data(), p.right.data() + p.right.size()), residual(x.size());
      solver->solve(
          x, residual, [&](std::span<const double> r) { return norm(r) / enough; }, kind);
      EXPECT_TRUE(solver->solved());
      EXPECT_LE(norm(residual), enough);
      EXPECT_GT(norm(residual), 1e-9);
      const Eigen::VectorXd missing =
          p.right - p.dense * Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
      return (Eigen::Map<Eigen::VectorXd>(residual.data(), missing.size()) - missing).cwiseAbs().maxCoeff();
    };
    for (double enough = 0.5 * norm({p.right.data(), static_cast<std::size_t>(p.right.size())});
         enough > 0.01; enough *= 0.5) {
      EXPECT_LT(error_of(BlockSolver::Residual::exact, enough), 1e-12);
      const double estimated = error_of(BlockSolver::Residual::estimated, enough);
      EXPECT_GT(estimated, 1e-12);  // it is an estimate
      EXPECT_LT(estimated, 1e-5) << "to " << enough;
    }
  }
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
  /// Of every block, and where the last one ends: the first of its unknowns.
  [[nodiscard]] std::vector<std::size_t> first() const {
    std::vector<std::size_t> first{0};
    for (const int size : sizes) first.push_back(first.back() + static_cast<std::size_t>(size));
    return first;
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
  /// A x
  [[nodiscard]] std::vector<double> product(std::span<const double> x) const {
    const std::vector<std::size_t> first = this->first();
    std::vector<double> y(x.size());
    for (std::size_t b = 0; b < sizes.size(); ++b) {
      for (std::size_t k = first[b]; k < first[b + 1]; ++k) y[k] = diagonal[b] * x[k];
    }
    for (std::size_t k = 0; k < grid.pairs.size(); ++k) {
      const auto i = static_cast<std::size_t>(grid.pairs[k].first),
                 j = static_cast<std::size_t>(grid.pairs[k].second);
      auto value = coupling[k].begin();
      for (std::size_t r = first[i]; r < first[i + 1]; ++r) {
        for (std::size_t c = first[j]; c < first[j + 1]; ++c, ++value) {
          y[r] += *value * x[c];
          y[c] += *value * x[r];
        }
      }
    }
    return y;
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
      EXPECT_EQ(problem.solution(*make_block_conjugate_residual(&team)), alone) << threads;
    }
  }
}

double largest(std::span<const double> numbers) {
  double found = 0.0;
  for (const double v : numbers) found = std::max(found, std::abs(v));
  return found;
}

// x ← A⁻¹ x near some blocks, zero elsewhere. The solver does not look at what belongs to blocks that it does not reach.
bool solve_local(BlockSolver& solver, std::span<const std::size_t> first,
                 const std::vector<std::size_t>& blocks, std::vector<double>& x,
                 std::vector<double>& residual, const BlockSolver::Excess& excess,
                 LocalSolver::Reach& reach) {
  LocalSolver* local = solver.local();
  if (local == nullptr || !local->find_local(blocks, reach)) return false;
  std::vector<bool> reached(x.size(), false);
  for (const std::size_t block : reach.blocks) {
    for (std::size_t k = first[block]; k < first[block + 1]; ++k) reached[k] = true;
  }
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> right = x;
  residual.assign(x.size(), unknown);
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!reached[k]) x[k] = unknown;
  }
  local->solve_local(x, residual, [&](std::span<const double> r) {
    std::vector<double> all = right;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (reached[k]) all[k] = r[k];
    }
    return excess(all);
  });
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (reached[k]) continue;
    EXPECT_TRUE(std::isnan(x[k]) && std::isnan(residual[k])) << k;
    x[k] = 0.0;
    residual[k] = right[k];
  }
  return true;
}

// Near some blocks, what is left over is what it says, also where that is beyond; and a system of all that follows knows nothing of it.
TEST(BlockSolver, SolvesNearSomeBlocks) {
  constexpr double enough = 1e-5, right = 1.0, of_others = 0.3 * enough;
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12, 20}}) {
    const GridProblem problem(choice);
    const std::vector<std::size_t> first = problem.first();
    const auto whole = problem.solution(*make_iterative());
    // In the middle of the grid, at its edge, and in the piece beside it.
    const std::vector<std::size_t> blocks{25 * Grid::side + 24, 25 * Grid::side + 26, 7, Grid::blocks - 3};
    std::vector<double> b(problem.right.size(), of_others);
    for (const std::size_t block : blocks)
      std::fill(b.data() + first[block], b.data() + first[block + 1], right);
    const auto excess = [&](std::span<const double> r) { return largest(r) / enough; };
    std::vector<double> alone;
    for (const int threads : {1, 2, 3}) {
      ThreadTeam team(threads);
      const auto solver = make_block_conjugate_residual(&team);
      problem.fill(*solver);
      ASSERT_TRUE(solver->factor());
      std::vector<double> x = b, residual(b.size());
      LocalSolver::Reach reach;
      ASSERT_TRUE(solve_local(*solver, first, blocks, x, residual, excess, reach));
      EXPECT_TRUE(solver->solved());
      const auto product = problem.product(x);
      const std::set<std::size_t> reached(reach.blocks.begin(), reach.blocks.end()),
          moves(reach.blocks.begin(), reach.blocks.begin() + static_cast<std::ptrdiff_t>(reach.moved));
      EXPECT_EQ(reached.size(), reach.blocks.size());
      std::size_t moved = 0;
      for (std::size_t block = 0; block < problem.sizes.size(); ++block) {
        const std::size_t begin = first[block], end = first[block + 1];
        for (std::size_t k = begin; k < end; ++k) {
          ASSERT_NEAR(residual[k], b[k] - product[k], 1e-13);
          if (reached.contains(block)) continue;
          ASSERT_EQ(residual[k], b[k]);
        }
        const bool has_x = largest(std::span(x).subspan(begin, end - begin)) > 0.0;
        EXPECT_EQ(has_x, moves.contains(block));
        moved += has_x ? 1 : 0;
      }
      EXPECT_GT(moved, 150U);
      EXPECT_LT(moved, 500U);
      for (const std::size_t block : blocks)
        EXPECT_LE(largest(std::span(residual).subspan(first[block], first[block + 1] - first[block])),
                  enough);
      EXPECT_GT(largest(residual), of_others) << "nothing is left beyond";
      EXPECT_LT(largest(residual), 0.1 * right);
      if (threads == 1) alone = x;
      EXPECT_EQ(x, alone) << threads;
      EXPECT_EQ(problem.factor_and_solve(*solver), whole);

      // Where little is to be done, what is left over beyond may be more than there was: no reason to give up.
      std::vector<double> little(b.size(), 0.899 * enough);
      std::fill(little.data() + first[7], little.data() + first[8], 1.001 * enough);
      x = little;
      ASSERT_TRUE(solve_local(*solver, first, std::vector<std::size_t>{7}, x, residual, excess, reach));
      EXPECT_GT(largest(residual), largest(little));
      EXPECT_TRUE(solver->solved());

      std::vector<std::size_t> all(problem.sizes.size());
      std::iota(all.begin(), all.end(), std::size_t{0});
      EXPECT_FALSE(solver->local()->find_local(all, reach)) << "all are as well";
    }
  }
}

// Nothing of a system that had no solution is left in the next.
TEST(BlockSolver, SolvesAfterASystemOfWhatIsNoNumber) {
  const GridProblem problem({6});
  const auto expected = problem.solution(*make_iterative());
  const auto solver = make_iterative();
  problem.fill(*solver);
  ASSERT_TRUE(solver->factor());
  std::vector<double> x(problem.right.size(), std::numeric_limits<double>::quiet_NaN()), residual(x.size());
  solver->solve(x, residual, [](std::span<const double>) { return 2.0; });
  EXPECT_FALSE(solver->solved());
  EXPECT_EQ(problem.factor_and_solve(*solver), expected);
}

TEST(BlockSolver, GivesUpNearSomeBlocksWhereTheMatrixIsNotPositiveDefinite) {
  GridProblem problem({6});
  constexpr std::size_t pair = 2'000;
  for (double& v : problem.coupling[pair]) v *= 100.0;
  const auto solver = make_iterative();
  problem.fill(*solver);
  ASSERT_TRUE(solver->factor());
  const auto [i, j] = problem.grid.pairs[pair];
  std::vector<double> x(problem.right.size(), 0.0), residual(x.size());
  LocalSolver::Reach reach;
  std::fill_n(x.data() + 6 * i, 6, 1.0);
  std::fill_n(x.data() + 6 * j, 6, -1.0);
  const std::vector<std::size_t> blocks{static_cast<std::size_t>(i), static_cast<std::size_t>(j)};
  ASSERT_TRUE(solve_local(
      *solver, problem.first(), blocks, x, residual,
      [&](std::span<const double> r) { return largest(r) / 1e-5; }, reach));
  EXPECT_FALSE(solver->solved());
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
