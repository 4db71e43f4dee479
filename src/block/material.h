#pragma once

namespace keyblock::block {

enum class PlaneState { plane_stress, plane_strain };

/// Isotropic elastic rock, St. Venant-Kirchhoff.
struct Material {
  double density = 0.0;  ///< kg/m³
  double young = 0.0;    ///< Pa
  double poisson = 0.0;
  PlaneState state = PlaneState::plane_stress;
  friend constexpr bool operator==(const Material&, const Material&) = default;
};

/// Stress before excavation, σ(X) = σ₀ + gradient · (y − y_ref), compression negative. Pa, Pa/m.
struct InSituStress {
  double sxx = 0.0, syy = 0.0, sxy = 0.0;
  double sxx_gradient = 0.0, syy_gradient = 0.0;  ///< per metre upwards
  double reference_y = 0.0;                       ///< where the constant parts hold
};

}  // namespace keyblock::block
