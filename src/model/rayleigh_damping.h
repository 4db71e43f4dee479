#pragma once
#include <numbers>

namespace keyblock::dynamics {

enum class DampingKind { stiffness, rayleigh, mass };

/// Rayleigh damping, C = α M + β K, with K of the rock and of its joints. What swings at a frequency ω loses ζ(ω) = ½ (α/ω + β ω) of critical.
struct RayleighDamping {
  double ratio = 0.0;      ///< share of critical at `frequency`
  double frequency = 0.0;  ///< Hz, above zero
  DampingKind kind = DampingKind::stiffness;

  /// α, 1/s
  [[nodiscard]] double mass_rate() const { return share_of_mass() * 2.0 * ratio * circular(frequency); }
  /// β, s
  [[nodiscard]] double stiffness_time() const {
    return (1.0 - share_of_mass()) * 2.0 * ratio / circular(frequency);
  }
  /// Share of critical at a frequency, Hz.
  [[nodiscard]] double ratio_at(double hertz) const {
    return 0.5 * (mass_rate() / circular(hertz) + stiffness_time() * circular(hertz));
  }

 private:
  static double circular(double hertz) { return 2.0 * std::numbers::pi * hertz; }
  [[nodiscard]] double share_of_mass() const {
    return kind == DampingKind::mass ? 1.0 : kind == DampingKind::rayleigh ? 0.5 : 0.0;
  }
};

}  // namespace keyblock::dynamics
