#pragma once
#include <vector>

#include "block/basis.h"

namespace keyblock::block {

/// cos w and sin w from series in +, − and × alone, so that every machine gets the same bits. Any w; no number where w is none.
void rotation(double w, double& cosine, double& sine);

/// Area and mean spin of a block of any order, and the pose update that keeps rotation exact.
///
/// With W_kl = ∫ (∂φ_k/∂X ∂φ_l/∂Y − ∂φ_k/∂Y ∂φ_l/∂X) dA (antisymmetric, constant):
///     current area   A = a_xᵀ W a_y
///     mean spin of D w = (D_xᵀ W a_x + D_yᵀ W a_y) / 2A   (skew part of the mean of ∇D over the current
///     configuration)
class Pose {
 public:
  Pose(const Polygon& region, const Basis& basis);

  [[nodiscard]] double area(const double* a) const;
  [[nodiscard]] double mean_spin(const double* increment, const double* a) const;
  /// docs/theory.md, section "Pose update". With c the centroid and r = x − c, the increment is D = D_c + w × r + D_def,
  /// and
  ///     x ← c + D_c + R(w)(r + D_def),      relative part of v ← R(w) v.
  /// w: its mean spin. a, v: coefficients of position and velocity (2N values each), changed in place.
  void update(double w, const double* increment, double* a, double* v) const;
  /// Turns the relative part of a vector of 2N coefficients by w.
  void rotate(double w, double* u) const;

 private:
  struct Sums {
    double area = 0.0;  ///< a_xᵀ W a_y
    double curl = 0.0;  ///< D_xᵀ W a_x + D_yᵀ W a_y
  };
  [[nodiscard]] Sums sums(const double* increment, const double* a) const;

  int size_;
  double w12_ = 0.0;       ///< W_12: at order 1 all there is, and at hand
  std::vector<double> w_;  ///< of other orders all of W, k and l from 1 on: columns, padded to whole lanes
};

}  // namespace keyblock::block
