#pragma once
#include <vector>

#include "geometry/polygon.h"
#include "geometry/quadrature.h"

namespace keyblock::block {

/// Number of polynomials of total degree ≤ n: N = (n + 1)(n + 2)/2. A block has 2N unknowns.
constexpr int basis_size(int order) {
  return (order + 1) * (order + 2) / 2;
}

/// Polynomials φ_k, k = 0 … N−1, of total degree ≤ n, orthonormal over a region Ω: ∫ φ_i φ_j dA = δ_ij.
///
/// They span the displacement polynomials of Hsiung 2001, equation (1). φ_0 = 1/√A; φ_1 and φ_2 are linear
/// and of zero mean; degrees ascend. The mass matrix of a block is therefore ρ I. Built from products of
/// Legendre polynomials on the bounding box of Ω, orthonormalized over Ω by two passes of Cholesky of the
/// Gram matrix (the second one restores what the first loses at high order).
class Basis {
 public:
  /// Throws std::invalid_argument for order < 1, a region of no area, and one too thin for the digits of so high an order.
  Basis(const Polygon& region, int order);

  [[nodiscard]] int order() const { return order_; }
  [[nodiscard]] int size() const { return size_; }
  /// phi[k] = φ_k(X); `phi` holds N values.
  void evaluate(Vec2 point, double* phi) const;
  /// gradient[k] = ∇φ_k(X), 1/m².
  void gradients(Vec2 point, Vec2* gradient) const;
  /// Coefficients a of the identity x(X) = X: N vectors, of which only the first three are not zero.
  [[nodiscard]] std::vector<Vec2> identity() const;

 private:
  void legendre(Vec2 point, double* value, Vec2* gradient) const;
  void orthonormalize(const std::vector<WeightedPoint>& rule);

  int order_;
  int size_;
  Vec2 centre_, half_size_;
  std::vector<double> coefficient_;  ///< lower triangular N × N, by rows: φ_i = Σ_j coefficient_[i, j] P_j
  std::vector<Vec2> identity_;
};

}  // namespace keyblock::block
