#include "linalg/bordered_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace keyblock::linalg {
namespace {

/// A matrix that is positive definite in some rows and negative definite in the others.
Eigen::MatrixXd quasi_definite(int n, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto number = [&] { return uniform(random); };
  const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, number);
  Eigen::MatrixXd a = root * root.transpose() / n;
  for (int i = 0; i < n; ++i) a(i, i) += i % 3 == 1 ? -10.0 : 0.1;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i % 3 == 1 && j % 3 == 1 && i != j) a(i, j) = -a(i, j);
    }
  }
  return a;
}

std::vector<double> solved(BorderedFactor& factor, const Eigen::VectorXd& right) {
  std::vector<double> x(right.begin(), right.end());
  factor.solve(x);
  return x;
}

// Whatever rows are kept, the bits are those of a factor that is made anew.
TEST(BorderedFactor, SolvesAndKeepsRows) {
  std::mt19937 random(5);
  BorderedFactor kept;
  std::size_t rows = 0;
  Eigen::MatrixXd a = quasi_definite(90, random);
  for (const int n : {1, 7, 8, 9, 23, 24, 61, 90, 40, 70}) {
    const auto entry = [&](std::size_t i, std::size_t j) {
      return a(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    };
    const auto size = static_cast<std::size_t>(n);
    BorderedFactor fresh;
    ASSERT_TRUE(fresh.factor(size, 0, entry));
    ASSERT_TRUE(kept.factor(size, rows, entry));
    rows = size;
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(n, -1.0, 2.0);
    const std::vector<double> x = solved(fresh, right);
    EXPECT_EQ(x, solved(kept, right)) << n;
    const Eigen::VectorXd expected = a.topLeftCorner(n, n).lu().solve(right);
    for (int i = 0; i < n; ++i) EXPECT_NEAR(x[static_cast<std::size_t>(i)], expected[i], 1e-11) << n;
    a(n / 2, n / 2) *= 1.01;
    rows = size / 2;
  }
}

TEST(BorderedFactor, ReportsZeroPivots) {
  BorderedFactor factor;
  EXPECT_FALSE(factor.factor(3, 0, [](std::size_t, std::size_t) { return 1.0; }));
  EXPECT_TRUE(factor.factor(2, 3, [](std::size_t i, std::size_t j) { return i == j ? 2.0 : 1.0; }));
}

}  // namespace
}  // namespace keyblock::linalg
