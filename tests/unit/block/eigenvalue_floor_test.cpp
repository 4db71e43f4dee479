#include "block/eigenvalue_floor.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace keyblock::block {
namespace {

constexpr int n = rows_of_order_2;
using Matrix = Eigen::Matrix<double, n, n>;

Matrix whole(const MatrixOfOrder2& g) {
  return Eigen::Map<const Matrix>(g.data()).selfadjointView<Eigen::Lower>();
}

MatrixOfOrder2 numbers(const Matrix& m) {
  MatrixOfOrder2 g;
  Eigen::Map<Matrix>(g.data()) = m;
  return g;
}

Matrix raised(const Matrix& m, double floor) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(-floor).asDiagonal() *
         solver.eigenvectors().transpose();
}

/// Symmetric, of sizes from 1e-6 to 1e6; some of them nearly diagonal, some with eigenvalues several times over.
std::vector<MatrixOfOrder2> matrices(int count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<MatrixOfOrder2> some;
  for (int k = 0; k < count; ++k) {
    Matrix m = Matrix::NullaryExpr([&] { return uniform(random); });
    m = (m + m.transpose()).eval();
    if (k % 4 == 1) m = (Matrix(m.diagonal().asDiagonal()) + 1e-9 * m).eval();
    if (k % 4 == 2) m = -(Matrix::Identity() + m.col(0) * m.col(0).transpose());
    some.push_back(numbers(std::pow(10.0, 6.0 * uniform(random)) * m));
  }
  some.push_back(numbers(Matrix::Zero()));
  some.push_back(numbers(-Matrix::Identity()));
  return some;
}

TEST(EigenvalueFloor, EightAtOnceAreThoseOfTheLibrary) {
  const std::vector<MatrixOfOrder2> given = matrices(600);
  for (std::size_t first = 0; first < given.size(); first += 7) {
    const std::size_t count = std::min<std::size_t>(1 + first % 8, given.size() - first);
    std::vector<MatrixOfOrder2> g(given.begin() + static_cast<std::ptrdiff_t>(first),
                                  given.begin() + static_cast<std::ptrdiff_t>(first + count));
    std::vector<double> floor;
    for (const MatrixOfOrder2& m : g) floor.push_back(0.2 * whole(m).norm());
    raise_eigenvalues(g, floor);
    for (std::size_t k = 0; k < count; ++k) {
      const Matrix before = whole(given[first + k]);
      EXPECT_LE((whole(g[k]) - raised(before, floor[k])).norm(), 1e-14 * before.norm()) << first + k;
    }
  }
}

TEST(EigenvalueFloor, NeighboursDoNotMatter) {
  const std::vector<MatrixOfOrder2> given = matrices(62);
  for (std::size_t first = 0; first + 8 <= given.size(); first += 8) {
    std::vector<MatrixOfOrder2> together(given.begin() + static_cast<std::ptrdiff_t>(first),
                                         given.begin() + static_cast<std::ptrdiff_t>(first + 8));
    const std::vector<double> floor(8, 1e-3);
    std::vector<MatrixOfOrder2> alone = together;
    raise_eigenvalues(together, floor);
    for (std::size_t k = 0; k < 8; ++k) {
      raise_eigenvalues(std::span(&alone[k], 1), std::span(floor).first(1));
      EXPECT_EQ(together[k], alone[k]);
    }
  }
}

TEST(EigenvalueFloor, NothingBelowIsMissed) {
  int spared = 0;
  for (const MatrixOfOrder2& g : matrices(400)) {
    const Matrix m = whole(g);
    const double lowest = Eigen::SelfAdjointEigenSolver<Matrix>(m).eigenvalues()[0];
    for (const double share : {0.1, 0.9, 0.999, 1.001, 1.1, 3.0}) {
      const double floor = share * m.norm();
      const bool may = may_lie_below(g.data(), n, floor);
      EXPECT_TRUE(may || lowest >= -floor * (1.0 + 1e-12));
      spared += may ? 0 : 1;
    }
    // Just below and just above.
    if (lowest < 0.0) {
      EXPECT_TRUE(may_lie_below(g.data(), n, -lowest * (1.0 - 1e-6)));
      EXPECT_FALSE(may_lie_below(g.data(), n, -lowest * (1.0 + 1e-6)));
    }
  }
  EXPECT_GT(spared, 800);
}

}  // namespace
}  // namespace keyblock::block
