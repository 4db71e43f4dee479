#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::loading {

/// What a section of a liner carries, per metre of thickness.
struct SectionForce {
  double normal = 0.0;  ///< N/m, tension positive
  double moment = 0.0;  ///< N m/m, positive where it stretches the inner side, that of the opening
  double shear = 0.0;   ///< N/m
};

/// Strength of a plain rectangular section: no stress in it is beyond the strengths over the safety factor.
///
///     M = (f_c/F − N/t) t²/6,  (f_t/F + N/t) t²/6      V² = (4/9) t² f/F (f/F ∓ N/t)      with N compression positive
///
/// The lines of V are those of principal stress in the middle of the section. Stresses are of degree one in the forces, so that the largest stress
/// over its strength says by how much all forces may grow.
struct SectionStrength {
  double thickness = 0.0;    ///< m
  double compressive = 0.0;  ///< Pa
  double tensile = 0.0;      ///< Pa
  double safety_factor = 1.0;

  /// Largest stress over what the section is allowed; 1: on the edge of the diagram.
  [[nodiscard]] double utilization(const SectionForce& force) const;
  /// N/m and N m/m, compression positive: the corners of the diagram of normal force and moment, M ≥ 0, from tension to compression.
  [[nodiscard]] std::vector<std::pair<double, double>> moments() const;
  /// N/m: the largest shear force beside a normal force, compression positive; 0 outside of the diagram.
  [[nodiscard]] double shear(double compression) const;
};

/// A liner of shotcrete on the wall of an opening: an elastic beam on an interface, per metre of thickness.
struct Liner {
  std::string name;
  int staged = -1;         ///< State::installed that says whether it is there; −1: always
  std::vector<Vec2> wall;  ///< its outer face, along which the rock is on the right; in reference position
  bool is_closed = false;  ///< the last point is joined to the first
  double thickness = 0.0;  ///< m
  double young = 0.0;      ///< Pa
  double poisson = 0.2;
  bool is_plane_strain = true;
  double density = 2400.0;                                       ///< kg/m³
  double normal_stiffness = 0.0;                                 ///< Pa/m, of the interface
  double shear_stiffness = 0.0;                                  ///< Pa/m
  double adhesion = 0.0;                                         ///< Pa, tensile strength
  double cohesion = 0.0;                                         ///< Pa
  double friction = 0.0;                                         ///< coefficient
  std::optional<double> compressive_strength, tensile_strength;  ///< Pa; empty: no utilization
  double safety_factor = 1.0;
  std::optional<double> element_length;  ///< m; empty: by its bending

  [[nodiscard]] double plane_modulus() const {
    return is_plane_strain ? young / (1.0 - poisson * poisson) : young;
  }
  [[nodiscard]] double axial_stiffness() const { return plane_modulus() * thickness; }  ///< N/m
  [[nodiscard]] double bending_stiffness() const {                                      ///< N m
    return plane_modulus() * thickness * thickness * thickness / 12.0;
  }
  /// m, largest distance of its stations: its own or, unless it has one, a third of the length 1/β over which bending fades, β = (k/4EI)^¼, at the most
  /// 0.25 m, and a quarter of its thickness at the least.
  [[nodiscard]] double station_spacing() const;
  /// Where it has strengths.
  [[nodiscard]] std::optional<SectionStrength> strength() const;
};

}  // namespace keyblock::loading
