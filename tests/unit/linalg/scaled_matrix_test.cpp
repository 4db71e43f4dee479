#include "linalg/scaled_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <random>

#include "linalg/neighbourhood.h"
#include "linalg/solved_part.h"
#include "linalg/upper_kernels.h"
#include "random_problem.h"

namespace keyblock::linalg {
namespace {

/// A grid of blocks, large enough for a partition of several parts.
struct GridSystem {
  static constexpr int side = 45;
  std::vector<int> sizes;
  std::vector<std::pair<int, int>> pairs;

  explicit GridSystem(const std::vector<int>& choice) {
    std::mt19937 random(4);
    for (int k = 0; k < side * side; ++k) {
      sizes.push_back(choice[random() % choice.size()]);
      if (k % side != 0) pairs.emplace_back(k - 1, k);
      if (k >= side) pairs.emplace_back(k, k - side);
    }
  }
};

TEST(BlockOrder, KnowsWhereBlocksAre) {
  const GridSystem grid({6, 12, 20});
  BlockOrder order;
  order.analyse(grid.sizes, grid.pairs);
  ASSERT_EQ(order.blocks(), grid.sizes.size());
  EXPECT_FALSE(order.all_of_six);
  EXPECT_EQ(order.largest, 24);
  std::vector<std::size_t> first(grid.sizes.size(), 0);
  std::partial_sum(grid.sizes.begin(), grid.sizes.end() - 1, first.begin() + 1);
  std::size_t padded = 0;
  for (std::size_t j = 0; j < order.blocks(); ++j) {
    const std::size_t block = at(order.block_at[j]);
    EXPECT_EQ(order.position[block], j);
    EXPECT_EQ(order.size[j], grid.sizes[block]);
    EXPECT_EQ(order.stride[j], padded_rows(grid.sizes[block]));
    EXPECT_EQ(order.offset[j], first[block]);
    EXPECT_EQ(order.start[j], padded);
    padded += at(order.stride[j]);
  }
  EXPECT_EQ(order.padded, padded);
  order.analyse(std::vector{6, 6}, std::vector{std::pair(0, 1)});
  EXPECT_TRUE(order.all_of_six);
  EXPECT_EQ(order.padded, 16U);
}

TEST(UpperPattern, HasEveryPairOnce) {
  const GridSystem grid({6, 12});
  BlockOrder order;
  order.analyse(grid.sizes, grid.pairs);
  ASSERT_GT(order.begin.size(), 3U) << "several parts";
  UpperPattern pattern;
  pattern.analyse(order, grid.pairs);
  EXPECT_EQ(pattern.row.size(), grid.pairs.size());
  std::size_t between = 0;
  for (std::size_t j = 0; j < order.blocks(); ++j) {
    const auto rows =
        std::span(pattern.row)
            .subspan(pattern.column_start[j], pattern.column_start[j + 1] - pattern.column_start[j]);
    EXPECT_TRUE(std::ranges::is_sorted(rows));
    for (const std::uint32_t i : rows) {
      EXPECT_LT(i, j);
      EXPECT_TRUE(std::ranges::find(pattern.neighbours(j), i) != pattern.neighbours(j).end());
    }
    // Rows between the parts come before those of the same part.
    for (std::uint32_t e = pattern.column_start[j]; e < pattern.column_start[j + 1]; ++e)
      EXPECT_EQ(e < pattern.own_start[j], j >= order.between() && pattern.row[e] < order.between());
    between += pattern.own_start[j] - pattern.column_start[j];
  }
  EXPECT_EQ(pattern.row_entries.size(), between);
  EXPECT_GT(between, 0U);
  std::vector<std::size_t> values = pattern.pair_value;
  std::ranges::sort(values);
  EXPECT_TRUE(std::ranges::adjacent_find(values) == values.end());
}

/// Brings a padded vector by position into the order of the caller, and back.
Eigen::VectorXd in_order_of_caller(const BlockOrder& order, const std::vector<double>& padded,
                                   Eigen::Index n) {
  Eigen::VectorXd x(n);
  for (std::size_t j = 0; j < order.blocks(); ++j) {
    for (std::size_t k = 0; k < at(order.size[j]); ++k)
      x[static_cast<Eigen::Index>(order.offset[j] + k)] = padded[order.start[j] + k];
  }
  return x;
}
std::vector<double> padded(const BlockOrder& order, const Eigen::VectorXd& x) {
  std::vector<double> v(order.padded, 0.0);
  for (std::size_t j = 0; j < order.blocks(); ++j) {
    for (std::size_t k = 0; k < at(order.size[j]); ++k)
      v[order.start[j] + k] = x[static_cast<Eigen::Index>(order.offset[j] + k)];
  }
  return v;
}

/// Adds the blocks of a problem to a matrix; as fill() of a solver.
void fill_matrix(ScaledMatrix& matrix, const Problem& p) {
  matrix.clear(nullptr);
  std::vector<int> first(p.sizes.size(), 0);
  std::partial_sum(p.sizes.begin(), p.sizes.end() - 1, first.begin() + 1);
  for (std::size_t i = 0; i < p.sizes.size(); ++i) {
    double* values = matrix.diagonal(static_cast<int>(i));
    for (int c = 0; c < p.sizes[i]; ++c) {
      for (int r = c; r < p.sizes[i]; ++r)
        values[c * padded_rows(p.sizes[i]) + r] += p.dense(first[i] + r, first[i] + c);
    }
  }
  for (std::size_t k = 0; k < p.pairs.size(); ++k) {
    const BlockSlot slot = matrix.slot(static_cast<int>(k));
    for (int c = 0; c < p.sizes[at(slot.column)]; ++c) {
      for (int r = 0; r < p.sizes[at(slot.row)]; ++r)
        slot.values[c * slot.stride + r] += p.dense(first[at(slot.row)] + r, first[at(slot.column)] + c);
    }
  }
}

// A = C (Uᵀ + 1 + U) Cᵀ, up to single precision.
TEST(ScaledMatrix, IsTheMatrixScaled) {
  for (const std::vector<int>& choice : {std::vector{6}, {6, 12, 20}}) {
    const Problem p = random_problem(3, 12, choice);
    ScaledMatrix matrix;
    matrix.analyse(p.sizes, p.pairs);
    fill_matrix(matrix, p);
    ASSERT_TRUE(matrix.factor(nullptr));
    const BlockOrder& order = matrix.order();
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(p.dense.rows(), [&] { return uniform(random); });
    // y −= A x, in double precision.
    std::vector<double> y(order.padded, 0.0);
    const std::vector<double> wide = padded(order, x);
    // Cᵀ x = C⁻¹ (C Cᵀ) x = C⁻¹ A_jj x, block by block.
    std::vector<float> scaled(order.padded, 0.0F), product(order.padded, 0.0F),
        transposed(order.padded, 0.0F);
    with_layout(order, [&](auto layout) {
      for (std::size_t j = 0; j < order.blocks(); ++j) {
        subtract_product_of(matrix, layout, j, wide.data(), y.data());
        std::vector<double> of_block(at(order.stride[j]), 0.0), w(at(order.stride[j]), 0.0);
        multiply(order.stride[j] / row_padding, order.size[j], matrix.column(j), &wide[order.start[j]],
                 of_block.data());
        multiply(order.stride[j] / row_padding, order.size[j], matrix.inverse(j), of_block.data(), w.data());
        std::ranges::copy(w, scaled.begin() + static_cast<std::ptrdiff_t>(order.start[j]));
      }
      for (std::size_t j = 0; j < order.blocks(); ++j) {
        subtract_scaled(matrix, layout, j, scaled.data(), product.data());
        store_transposed(matrix, layout, j, scaled.data(), transposed.data());
      }
      subtract_scaled_of_parts(matrix, SolvedPart(order, nullptr, nullptr), layout, scaled.data(),
                               product.data());
    });
    const Eigen::VectorXd expected = p.dense * x;
    EXPECT_LT((in_order_of_caller(order, y, x.size()) + expected).norm(), 1e-12 * expected.norm());
    std::vector<double> by_parts(order.padded, 0.0);
    for (std::size_t j = 0; j < order.blocks(); ++j) {
      std::vector<float> sum(at(order.stride[j]), 0.0F), of_block(at(order.stride[j]), 0.0F);
      for (std::size_t k = 0; k < sum.size(); ++k)
        sum[k] = scaled[order.start[j] + k] + transposed[order.start[j] + k] - product[order.start[j] + k];
      multiply(order.stride[j] / row_padding, order.size[j], matrix.scale(j), sum.data(), of_block.data());
      std::ranges::copy(of_block, by_parts.begin() + static_cast<std::ptrdiff_t>(order.start[j]));
    }
    EXPECT_LT((in_order_of_caller(order, by_parts, x.size()) - expected).norm(), 1e-5 * expected.norm());
  }
}

// What few blocks changed is scaled alone, to the same bits as all.
TEST(ScaledMatrix, TouchedBlocksAreScaledAgain) {
  Problem p = random_problem(8, 40, {6});
  ScaledMatrix some, all;
  for (ScaledMatrix* matrix : {&some, &all}) {
    matrix->analyse(p.sizes, p.pairs);
    fill_matrix(*matrix, p);
    ASSERT_TRUE(matrix->factor(nullptr));
    for (const int block : {3, 17}) {
      for (int k = 0; k < 6; ++k) matrix->diagonal(block)[k * padded_rows(6) + k] += 1.5;
    }
  }
  for (const int block : {3, 17, 3}) some.touch(block);
  for (int block = 0; block < 40; ++block) all.touch(block);
  const std::vector<float> before(some.above(), some.above() + some.pattern().scaled);
  ASSERT_TRUE(some.factor(nullptr));
  ASSERT_TRUE(all.factor(nullptr));
  EXPECT_TRUE(std::equal(some.above(), some.above() + some.pattern().scaled, all.above()));
  EXPECT_FALSE(std::equal(before.begin(), before.end(), some.above()));
  for (std::size_t j = 0; j < 40; ++j) {
    EXPECT_TRUE(std::equal(some.inverse(j), some.inverse(j) + 48, all.inverse(j))) << j;
    EXPECT_TRUE(std::equal(some.scale(j), some.scale(j) + 48, all.scale(j))) << j;
  }
  some.diagonal(5)[0] = -1.0;
  some.touch(5);
  EXPECT_FALSE(some.factor(nullptr)) << "not positive definite";
}

TEST(Neighbourhood, HasSomeLayersAndTheirEdge) {
  const GridSystem grid({6});
  BlockOrder order;
  order.analyse(grid.sizes, grid.pairs);
  UpperPattern pattern;
  pattern.analyse(order, grid.pairs);
  Neighbourhood near;
  const int row = 20, column = 11;
  ASSERT_TRUE(near.collect(order, pattern, std::vector<std::size_t>{row * GridSystem::side + column}));
  const auto distance = [&](std::size_t position) {
    const int block = order.block_at[position];
    return std::abs(block / GridSystem::side - row) + std::abs(block % GridSystem::side - column);
  };
  std::size_t inside = 0, beside = 0;
  for (std::size_t j = 0; j < order.blocks(); ++j) {
    EXPECT_EQ(near.has(j), distance(j) <= numbers::local_layers) << j;
    inside += distance(j) <= numbers::local_layers ? 1 : 0;
    beside += distance(j) == numbers::local_layers + 1 ? 1 : 0;
  }
  EXPECT_EQ(near.positions().size(), inside);
  EXPECT_EQ(near.edge().size(), beside);
  for (const std::uint32_t j : near.edge()) EXPECT_EQ(distance(j), numbers::local_layers + 1);
  EXPECT_TRUE(std::ranges::is_sorted(near.positions()));
  // Pieces are those of the parts.
  std::size_t in_pieces = 0;
  for (std::size_t k = 0; k < near.pieces(); ++k) {
    for (const std::uint32_t j : near.piece(k)) EXPECT_EQ(j < order.between(), k == 0);
    in_pieces += near.piece(k).size();
  }
  EXPECT_EQ(in_pieces, inside);
  std::vector<std::size_t> many(order.blocks());
  std::iota(many.begin(), many.end(), std::size_t{0});
  EXPECT_FALSE(near.collect(order, pattern, many)) << "a system of all is as well";
}

TEST(SolvedPart, GoesThroughItsPositionsOnce) {
  const GridSystem grid({6});
  BlockOrder order;
  order.analyse(grid.sizes, grid.pairs);
  UpperPattern pattern;
  pattern.analyse(order, grid.pairs);
  Neighbourhood near;
  ASSERT_TRUE(near.collect(order, pattern, std::vector<std::size_t>{0, 1000}));
  ThreadTeam two(2);
  for (ThreadTeam* team : {static_cast<ThreadTeam*>(nullptr), &two}) {
    for (const Neighbourhood* local :
         {static_cast<const Neighbourhood*>(nullptr), &static_cast<const Neighbourhood&>(near)}) {
      const SolvedPart part(order, local, team);
      std::vector<int> forward(order.blocks(), 0), backward(order.blocks(), 0), rows(order.blocks(), 0);
      part.for_pieces([&](std::size_t k, auto positions) {
        EXPECT_LT(k, part.pieces());
        for_each_position(positions, [&](std::size_t j) { ++forward[j]; });
        for_each_backward(positions, [&](std::size_t j) { ++backward[j]; });
      });
      part.for_rows_between([&](std::size_t j) { ++rows[j]; });
      for (std::size_t j = 0; j < order.blocks(); ++j) {
        const int expected = part.has(j) ? 1 : 0;
        EXPECT_EQ(forward[j], expected);
        EXPECT_EQ(backward[j], expected);
        EXPECT_EQ(rows[j], j < order.between() ? expected : 0);
      }
      EXPECT_EQ(part.edge().empty(), local == nullptr);
    }
  }
}

}  // namespace
}  // namespace keyblock::linalg
