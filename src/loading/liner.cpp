#include "loading/liner.h"

#include <algorithm>
#include <cmath>

namespace keyblock::loading {

double SectionStrength::utilization(const SectionForce& force) const {
  const double mean = force.normal / thickness, bend = 6.0 * std::abs(force.moment) / (thickness * thickness),
               shear_stress = 1.5 * force.shear / thickness, half = std::hypot(0.5 * mean, shear_stress);
  const double pulls = std::max(mean + bend, 0.5 * mean + half),
               presses = std::max(bend - mean, half - 0.5 * mean);
  return safety_factor * std::max(pulls / tensile, presses / compressive);
}

std::vector<std::pair<double, double>> SectionStrength::moments() const {
  const double c = compressive / safety_factor, s = tensile / safety_factor;
  return {{-s * thickness, 0.0},
          {0.5 * (c - s) * thickness, (c + s) / 12.0 * thickness * thickness},
          {c * thickness, 0.0}};
}

double SectionStrength::shear(double compression) const {
  const double c = compressive / safety_factor, s = tensile / safety_factor, mean = compression / thickness;
  const double squared = std::min(c * (c - mean), s * (s + mean));
  return 2.0 / 3.0 * thickness * std::sqrt(std::max(squared, 0.0));
}

double Liner::station_spacing() const {
  constexpr double shares_of_decay = 3.0, longest = 0.25, least_of_thickness = 0.25;
  const double decay = std::pow(4.0 * bending_stiffness() / normal_stiffness, 0.25);
  return element_length.value_or(
      std::min(longest, std::max(decay / shares_of_decay, least_of_thickness * thickness)));
}

std::optional<SectionStrength> Liner::strength() const {
  if (!compressive_strength || !tensile_strength) return std::nullopt;
  return SectionStrength{thickness, *compressive_strength, *tensile_strength, safety_factor};
}

}  // namespace keyblock::loading
