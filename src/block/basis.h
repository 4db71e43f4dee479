#pragma once
#include <array>
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
/// They span the displacement polynomials of Hsiung 2001, equation (1). φ_0 = 1/√A; φ_1 and φ_2 are linear and of zero mean; degrees
/// ascend, and a basis of order n begins with those of all lower orders, to the last bit. The mass matrix of a block is therefore ρ I.
/// Those of degree d ≥ 2 are made from those of degree d − 1 times a linear one, less what the polynomials before them share with the
/// product (Arnoldi's method; Brubeck, Nakatsukasa & Trefethen 2021), and evaluated by the same recurrence: unlike coefficients of
/// given polynomials, it keeps its digits at high orders, and for thin and for inclined regions.
class Basis {
 public:
  /// Throws std::invalid_argument for order < 1, a region of no area, and one on which a polynomial of the order
  /// (nearly) vanishes: two crossed slits.
  Basis(const Polygon& region, int order);

  [[nodiscard]] int order() const { return order_; }
  [[nodiscard]] int size() const { return size_; }
  /// phi[k] = φ_k(X); `phi` holds N values.
  void evaluate(Vec2 point, double* phi) const;
  /// gradient[k] = ∇φ_k(X), 1/m².
  void gradients(Vec2 point, Vec2* gradient) const;
  /// Coefficients a of the identity x(X) = X: N vectors, of which only the first three are not zero.
  [[nodiscard]] std::vector<Vec2> identity() const;

  /// What a polynomial of degree ≥ 2 is made from: one of the degree below, and φ_1 or φ_2.
  struct Product {
    int parent, factor;
  };

 private:
  /// Coefficients of φ_0 to φ_2: lower triangle, by rows, of 1 and the two coordinates over the half sides of the box around Ω.
  using Linear = std::array<std::array<double, 3>, 3>;
  void orthonormalize_linear(const std::vector<WeightedPoint>& rule);
  void append_degree(int degree, const std::vector<WeightedPoint>& rule);
  [[nodiscard]] std::vector<std::vector<double>> values_at(const std::vector<WeightedPoint>& rule) const;
  void evaluate_linear(Vec2 point, double* phi) const;

  int order_;
  int size_;
  Vec2 centre_, half_size_;
  Linear linear_{};
  std::vector<Product> products_;  ///< of k = 3 … N−1
  /// Rows k = 3 … N−1 of k + 1 numbers h: h_kk φ_k = φ_factor φ_parent / φ_0 − Σ_{j < k} h_kj φ_j.
  std::vector<double> recurrence_;
  std::vector<Vec2> identity_;
};

}  // namespace keyblock::block
