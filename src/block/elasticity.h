#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "block/basis.h"
#include "block/material.h"
#include "core/lanes.h"

namespace keyblock::block {

/// Symmetric tensor of the plane.
template <typename Number>
struct SymmetricTensor {
  Number xx{}, yy{}, xy{};
};
using Stress = SymmetricTensor<double>;

/// Stress before excavation at a point; zero without one.
Stress in_situ_at(const std::optional<InSituStress>& in_situ, Vec2 point);

/// Strain energy of one block of any order: St. Venant-Kirchhoff, E = ½(FᵀF − I), S = S₀ + C : E.
///
///     U(a) = ∫ S₀ : E + ½ E : C : E dA,     F = Σ_k a_k ⊗ ∇φ_k
///     f_k  = ∂U/∂a_k = ∫ F S ∇φ_k dA                                         (N vectors)
///     K    = ∂²U/∂a² = ∫ Bᵀ C B dA + ∫ (∇φ_k · S ∇φ_l) I dA                    (2N × 2N)
///
/// Invariant under rotation. Integrals are exact: the rule has degree 4(n − 1), which a linear S₀ exceeds at n = 1 alone, where it
/// asks for degree 1. Per unit thickness. Coefficients are ordered a_0x, a_0y, a_1x, … as everywhere.
class Elasticity {
 public:
  Elasticity(const Polygon& region, const Basis& basis, const Material& material,
             const std::optional<InSituStress>& in_situ);

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] double energy(const double* a) const;
  /// force[2k + c] += f_k, and the first integral of K, times 1 + viscous: Kelvin-Voigt damping β ∂E/∂t over a step adds β/Δt.
  /// tangent: 2N × 2N with leading dimension `stride`; of the lower triangle (symmetric) the columns that are not zero, from the third on,
  /// are written. geometric: room for the (N − 1)² numbers ∫ ∇φ_k · S ∇φ_l dA of the second, k and l from 1 on; their lower triangle, by
  /// columns.
  void add_force_and_material_tangent(const double* a, double viscous, double* force, double* tangent,
                                      int stride, double* geometric) const;
  /// The second integral, given these numbers.
  void add_geometric_tangent(const double* geometric, double* tangent, int stride) const;
  /// ∫ δE : C : δE dA with δE the linear part of the strain that increment d adds at a: dᵀ (material part of K) d. J.
  [[nodiscard]] double material_work(const double* a, const double* d) const;
  /// U(a + d) − U(a) − fᵀ d − ½ dᵀ K d: what the energy changes by beyond second order. U is of fourth degree along d, so that its values at
  /// a, a ± d/2 and a ± d say it exactly. J.
  [[nodiscard]] double beyond_second_order(const double* a, const double* d) const;
  /// ∫ |S(a) − S(b)|² dA of the second Piola-Kirchhoff stress, Pa² m²; with a null b, of S(a) itself.
  [[nodiscard]] double squared_stress(const double* a, const double* b) const;
  /// Cauchy stress σ = F S Fᵀ / det F at a point of the region.
  [[nodiscard]] Stress cauchy(const double* a, const Basis& basis, Vec2 point) const;
  /// Mean of the Cauchy stress over the region, weighted by reference area.
  [[nodiscard]] Stress mean_cauchy(const double* a) const;

 private:
  // Everything is computed at one point, a double, or at as many as there are lanes.
  template <typename Number>
  struct Deformation {
    Number xx{}, xy{}, yx{}, yy{};  ///< F_ij
  };
  template <typename Number>
  struct Gradient {
    Number x{}, y{};
  };
  /// Of the rule.
  template <typename Number>
  struct Point {
    Number weight{};                  ///< m²
    SymmetricTensor<Number> initial;  ///< S₀
  };
  /// Calls what(N, points, ∇φ_k at them): order 1 with its one point, others with all of theirs.
  template <typename Do>
  void with_points(const Do& what) const;
  /// Σ over the points of value(N, point, ∇φ at it).
  template <typename Value>
  [[nodiscard]] double sum_over_points(const Value& value) const;
  template <typename Number, typename Size>
  static Deformation<Number> deformation(Size size, const double* a, const Gradient<Number>* gradients);
  template <typename Number>
  [[nodiscard]] SymmetricTensor<Number> second_piola(const Deformation<Number>& f,
                                                     const SymmetricTensor<Number>& initial) const;
  /// B_k at a point: the columns of x and y.
  template <typename Number>
  struct Columns {
    Number x[3], y[3];  // of three rows
  };
  template <typename Number>
  struct Stressed {
    SymmetricTensor<Number> stress;  // times the weight
    Number weight;
  };
  template <typename Number, typename Size>
  void add_force(Size size, std::span<const Point<Number>> points, const Gradient<Number>* gradients,
                 const double* a, double viscous, double* force, Columns<Number>* b,
                 Stressed<Number>* stressed) const;
  template <typename Number, typename Size>
  void write_tangent(Size size, std::span<const Stressed<Number>> stressed, const Gradient<Number>* gradients,
                     const Columns<Number>* b, Columns<Number>* cb, double* tangent, int stride,
                     double* geometric) const;

  int size_;
  double c11_, c12_, c33_;  ///< plane elasticity matrix; c22 = c11
  // Of order 1, here: what a step reads of a block comes in one piece.
  Point<double> point_;
  std::array<Gradient<double>, 3> gradient_;
  // Of other orders, by groups of as many points as there are lanes; what the last lacks has no weight.
  std::vector<Point<Lanes>> points_;
  std::vector<Gradient<Lanes>> gradients_;  ///< ∇φ_k in group g: [g N + k]
  std::optional<InSituStress> in_situ_;
};

}  // namespace keyblock::block
