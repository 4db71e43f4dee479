#include "block/eigenvalue_floor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/lanes.h"

namespace keyblock::block {

namespace {

template <typename Number>
Number& entry(Number* g, int n, int r, int c) {
  return g[r >= c ? c * n + r : r * n + c];
}

/// Whether a + shift · 1 has a Cholesky factor; a is overwritten.
template <typename Matrix>
bool is_positive_definite(Matrix& a, double shift) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    const double pivot = a(j, j) + shift;
    if (!(pivot > 0.0)) return false;
    for (Eigen::Index q = j + 1; q < n; ++q) {
      const double factor = a(q, j) / pivot;
      for (Eigen::Index r = q; r < n; ++r) a(r, q) -= factor * a(r, j);
    }
  }
  return true;
}

/// Matrix: of Eigen, n × n.
template <typename Matrix>
bool may_lie_below_of(const double* g, int n, double floor) {
  double bound = 0.0;  // Gershgorin
  for (int i = 0; i < n; ++i) {
    double others = 0.0;
    for (int k = 0; k < n; ++k) others += k == i ? 0.0 : std::abs(entry(g, n, i, k));
    bound = std::max(bound, others - entry(g, n, i, i));
  }
  if (bound <= floor) return false;
  Matrix lower(n, n);
  for (int c = 0; c < n; ++c) {
    for (int r = c; r < n; ++r) lower(r, c) = entry(g, n, r, c);
  }
  return !is_positive_definite(lower, floor);
}

/// Of a 2 × 2 matrix.
void raise_two_eigenvalues(double* g, double floor) {
  const double mean = 0.5 * (g[0] + g[3]), half = 0.5 * (g[0] - g[3]);
  const double radius = std::sqrt(half * half + g[1] * g[1]);
  if (mean - radius >= -floor) return;
  const double high = std::max(mean + radius, -floor);
  // What differs from a multiple of 1 keeps its directions.
  const double scale = radius > 0.0 ? 0.5 * (high + floor) / radius : 0.0, middle = 0.5 * (high - floor);
  g[0] = middle + scale * half;
  g[3] = middle - scale * half;
  g[1] *= scale;
}

Lanes magnitude(Lanes x) {
  return largest(x, -x);
}

/// V and Λ of A = V Λ Vᵀ, for as many matrices as there are lanes.
struct Eigenvectors {
  static constexpr int n = rows_of_order_2;
  Lanes a[n][n];  ///< lower triangle; Λ on the diagonal in the end
  Lanes v[n][n]{};

  /// Turns rows and columns p and q, p < q, so that a_qp is zero; not at all where it is at most `negligible`.
  void rotate(int p, int q, Lanes negligible) {
    const Lanes one = broadcast(1.0), zero{};
    const Lanes off = a[q][p];
    const auto turns = magnitude(off) > negligible;
    // tan of the angle, the root of t² + 2 τ t − 1 that is nearer to zero
    const Lanes tau = (a[q][q] - a[p][p]) / (2.0 * where(turns, off, one));
    const Lanes root = magnitude(tau) + square_root(one + tau * tau);
    const Lanes t = where(turns, where(tau < zero, -one, one) / root, zero);
    const Lanes c = one / square_root(one + t * t), s = t * c;
    a[p][p] -= t * off;
    a[q][q] += t * off;
    a[q][p] = where(turns, zero, off);
    const auto turn = [&](Lanes& x, Lanes& y) {
      const Lanes x_before = x;
      x = c * x_before - s * y;
      y = s * x_before + c * y;
    };
    const auto lower = [&](int i, int k) -> Lanes& { return i > k ? a[i][k] : a[k][i]; };
    for (int k = 0; k < n; ++k) {
      if (k != p && k != q) turn(lower(p, k), lower(q, k));
      turn(v[k][p], v[k][q]);
    }
  }

  void find() {
    constexpr int most_sweeps = 20;       // four to six do
    constexpr double negligible = 1e-17;  // of the norm
    Lanes squares{};
    for (int r = 0; r < n; ++r) {
      v[r][r] = broadcast(1.0);
      for (int c = 0; c <= r; ++c) squares += (r == c ? 1.0 : 2.0) * a[r][c] * a[r][c];
    }
    const Lanes least = negligible * square_root(squares);
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      auto left = Lanes{} > Lanes{};
      for (int p = 0; p < n; ++p) {
        for (int q = p + 1; q < n; ++q) left |= magnitude(a[q][p]) > least;
      }
      if (!any(left)) return;
      for (int p = 0; p < n; ++p) {
        for (int q = p + 1; q < n; ++q) rotate(p, q, least);
      }
    }
  }
};

}  // namespace

bool may_lie_below(const double* g, int n, double floor) {
  if (n == rows_of_order_2)
    return may_lie_below_of<Eigen::Matrix<double, rows_of_order_2, rows_of_order_2>>(g, n, floor);
  return may_lie_below_of<Eigen::MatrixXd>(g, n, floor);
}

void raise_eigenvalues(double* g, int n, double floor) {
  if (n == 2) return raise_two_eigenvalues(g, floor);
  Eigen::MatrixXd whole(n, n);
  for (int c = 0; c < n; ++c) {
    for (int r = 0; r < n; ++r) whole(r, c) = entry(g, n, r, c);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(whole);
  if (solver.eigenvalues().minCoeff() >= -floor) return;
  const auto& vectors = solver.eigenvectors();
  whole = vectors * solver.eigenvalues().cwiseMax(-floor).asDiagonal() * vectors.transpose();
  for (int c = 0; c < n; ++c) {
    for (int r = c; r < n; ++r) entry(g, n, r, c) = whole(r, c);
  }
}

void raise_eigenvalues(std::span<MatrixOfOrder2> g, std::span<const double> floor) {
  constexpr int n = rows_of_order_2;
  Eigenvectors vectors{};
  Lanes least{};
  for (std::size_t lane = 0; lane < g.size(); ++lane) {
    least[lane] = -floor[lane];
    for (int c = 0; c < n; ++c) {
      for (int r = c; r < n; ++r) vectors.a[r][c][lane] = entry(g[lane].data(), n, r, c);
    }
  }
  vectors.find();
  Lanes missing[n];
  for (int k = 0; k < n; ++k) missing[k] = largest(least - vectors.a[k][k], Lanes{});
  for (int c = 0; c < n; ++c) {
    for (int r = c; r < n; ++r) {
      Lanes change{};
      for (int k = 0; k < n; ++k) change += missing[k] * vectors.v[r][k] * vectors.v[c][k];
      for (std::size_t lane = 0; lane < g.size(); ++lane) entry(g[lane].data(), n, r, c) += change[lane];
    }
  }
}

}  // namespace keyblock::block
