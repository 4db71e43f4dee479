#pragma once
#include <cmath>
#include <numbers>

#include "geometry/vec2.h"

namespace keyblock::rockmass {

/// Geometry of a joint plane in a vertical section (Priest 1993, Discontinuity Analysis for Rock Engineering,
/// ch. 3).
///
/// The x axis of the section points to `azimuth` (degrees from north), y is up. β is the dip, δ = dip
/// direction − azimuth. The plane meets the section in a line along
///     t = (cos α, −sin α),   tan α = tan β cos δ,
/// where the apparent dip α is positive when the line falls toward +x. All angles in degrees.

constexpr double radians(double degrees) {
  return degrees * (std::numbers::pi / 180.0);
}

/// α in (−180, 180]; in [−90, 90] for dips between 0 and 90. A dip beyond 90 is the plane that dips the other
/// way, as scatter may produce it.
inline double apparent_dip(double dip, double dip_direction, double azimuth) {
  const double delta = radians(dip_direction - azimuth);
  return std::atan2(std::sin(radians(dip)) * std::cos(delta), std::cos(radians(dip))) / radians(1.0);
}

/// Distance of the traces in the section over the true spacing of the planes: 1/√(1 − (n·m)²), n normal to
/// the planes, m normal to the section, |n·m| = sin β |sin δ|. Infinite when the planes are parallel to the
/// section.
inline double trace_spacing_factor(double dip, double dip_direction, double azimuth) {
  const double sine = std::sin(radians(dip)) * std::sin(radians(dip_direction - azimuth));
  const double rest = 1.0 - sine * sine;
  return rest > 0.0 ? 1.0 / std::sqrt(rest) : HUGE_VAL;
}

}  // namespace keyblock::rockmass
