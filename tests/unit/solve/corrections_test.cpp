#include "solve/corrections.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace keyblock::dynamics {
namespace {

constexpr int block_count = 12, block_size = 6, unknowns = block_count * block_size;

/// Masses on a chain: block k is coupled with block k + 1.
struct Chain {
  std::unique_ptr<linalg::BlockSolver> solver = linalg::make_block_cholesky();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(unknowns, unknowns);

  Chain() {
    std::vector<std::pair<int, int>> pairs;
    for (int k = 0; k + 1 < block_count; ++k) pairs.emplace_back(k, k + 1);
    solver->analyse(std::vector<int>(block_count, block_size), pairs);
    solver->clear();
    for (int k = 0; k < block_count; ++k) {
      for (int u = 0; u < block_size; ++u) add(k, u, k, u, 1.0);
    }
  }
  void add(int i, int u, int j, int v, double value) {
    dense(block_size * i + u, block_size * j + v) += value;
    if (i == j) {
      solver->diagonal(i)[v * linalg::padded_rows(block_size) + u] += value;
    } else if (i + 1 == j) {
      const linalg::BlockSlot slot = solver->slot(i);
      const int row = slot.row == i ? u : v, column = slot.row == i ? v : u;
      slot.values[column * slot.stride + row] += value;
    }
  }
};

/// A spring between two neighbours.
struct Spring {
  int block = 0;
  std::vector<double> a, b;  // ∂e/∂D of the two blocks
  Corrections::Law law;
  double rest = 0.0;

  [[nodiscard]] Eigen::VectorXd derivative() const {
    Eigen::VectorXd v = Eigen::VectorXd::Zero(unknowns);
    for (int u = 0; u < block_size; ++u) {
      v[block_size * block + u] = a[static_cast<std::size_t>(u)];
      v[block_size * (block + 1) + u] = b[static_cast<std::size_t>(u)];
    }
    return v;
  }
};

// Springs a hundred times stiffer than what the blocks rest on, some of them in the matrix: whatever their laws make of them, the
// forces balance in the end.
TEST(Corrections, ReachTheMinimum) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    Chain chain;
    std::vector<Spring> springs;
    for (int s = 0; s < 40; ++s) {
      Spring spring;
      spring.block = static_cast<int>(random() % (block_count - 1));
      for (int u = 0; u < block_size; ++u) {
        spring.a.push_back(uniform(random));
        spring.b.push_back(uniform(random));
      }
      spring.rest = uniform(random);
      Corrections::Law& law = spring.law;
      law.spring.stiffness = 100.0 * std::exp(uniform(random));
      if (random() % 2 == 0) {  // that does not pull
        law.spring.high = HUGE_VAL;
      } else {  // with friction, or the bound zero
        law.spring.high = random() % 4 == 0 ? 0.0 : 30.0 * (1.0 + uniform(random));
        law.spring.low = -law.spring.high;
      }
      if (random() % 2 == 0) law.line_stiffness = law.spring.stiffness;
      if (law.line_stiffness == 0.0 && std::isfinite(law.spring.high)) law.line_force = law.spring.high;
      if (law.line_stiffness > 0.0) {
        const Eigen::VectorXd v = spring.derivative();
        for (int i = 0; i < unknowns; ++i) {
          for (int j = 0; j < unknowns; ++j) {
            if (v[i] != 0.0 && v[j] != 0.0)
              chain.add(i / block_size, i % block_size, j / block_size, j % block_size,
                        law.spring.stiffness * v[i] * v[j]);
          }
        }
      }
      springs.push_back(spring);
    }
    ASSERT_TRUE(chain.solver->factor());
    Eigen::VectorXd right = Eigen::VectorXd::NullaryExpr(unknowns, [&] { return 20.0 * uniform(random); });
    for (const Spring& s : springs)
      right -= s.derivative() * (s.law.line_force + s.law.line_stiffness * s.rest);

    linalg::LowRankSolver& halves = *chain.solver->low_rank();
    std::vector<double> base;
    halves.forward_solve(std::span(right.data(), unknowns), base);
    Corrections corrections;
    std::vector<Corrections::Law> laws;
    std::vector<double> stretch, d(unknowns);
    std::vector<linalg::LowRankSolver::PairVector> vectors;
    for (const Spring& s : springs) vectors.push_back({{s.block, s.a}, {s.block + 1, s.b}});
    corrections.add(halves, std::span(vectors).first(15));
    corrections.add(halves, std::span(vectors).subspan(15));
    for (const Spring& s : springs) {
      laws.push_back(s.law);
      stretch.push_back(s.rest);
    }
    ASSERT_TRUE(corrections.solve(halves, base, laws, stretch)) << trial;
    corrections.finish(halves, base, d);
    const Eigen::VectorXd x = Eigen::Map<Eigen::VectorXd>(d.data(), unknowns);
    Eigen::VectorXd gradient = chain.dense * x - right;
    for (const Spring& s : springs) gradient += s.derivative() * s.law.excess(s.rest + s.derivative().dot(x));
    EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-9) << trial;
  }
}

}  // namespace
}  // namespace keyblock::dynamics
