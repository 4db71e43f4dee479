#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "loading/ground_motion.h"

/// Intensities of shaking by the names that hazard curves have for them, and of which direction they are.
///
///   PGA, PGV, PGD      largest |a|, |v|, |d|; velocity and displacement from rest
///   SA(T)              ω² max |x| of an oscillator of 5 % damping
///   AvgSA(T1,T2)       exp of the mean of ln SA(T) at ten periods, evenly spaced in ln T
///   IA                 π/2g ∫ a² dt
///   CAV                ∫ |a| dt
///   RSD575, RSD595     time from 5 to 75, 95 % of ∫ a² dt
///
/// All are exact for acceleration that is linear between samples, but PGV and PGD, which look at the samples.
namespace keyblock::loading {

enum class IntensityKind { pga, pgv, pgd, sa, average_sa, arias, cav, duration };

struct IntensityName {
  IntensityKind kind = IntensityKind::pga;
  std::string text;             ///< "SA(0.3)"
  std::vector<double> periods;  ///< s: of SA and AvgSA
  double share = 0.0;           ///< at which a duration ends
  std::string unit;
  int power = 1;  ///< of the factor on the accelerations that it goes with; 0: it does not change
};
/// None: there is no such intensity.
std::optional<IntensityName> intensity_named(std::string_view text);
inline constexpr std::string_view intensity_names_text = "PGA, PGV, PGD, SA(T), AvgSA(T1,T2), IA or CAV";

/// Of two horizontal components at right angles.
enum class DirectionRule {
  rotd50,           ///< the median over all directions (Boore 2010)
  rotd100,          ///< the largest of them
  geometric_mean,   ///< of the components as recorded
  arithmetic_mean,  ///< likewise
  larger,           ///< likewise
};

/// horizontal: x to the north, y to the east (horizontal_motion); azimuth: ° of its first component as recorded. The direction of AvgSA is chosen period by period.
double intensity_of(const GroundMotion& horizontal, const IntensityName& name, DirectionRule rule,
                    double azimuth = 0.0);

/// Of acceleration along one direction, m/s², at times from 0.
double intensity_along(const std::vector<double>& time, const std::vector<double>& acceleration,
                       const IntensityName& name);

}  // namespace keyblock::loading
