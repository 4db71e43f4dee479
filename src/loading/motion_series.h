#pragma once
#include <vector>

#include "loading/motion_file.h"
#include "loading/projection.h"

namespace keyblock::loading {

/// A component over time, after a correction of its baseline. All are exact for acceleration linear between samples; the ground is at
/// rest at the first one.
struct MotionSeries {
  std::vector<double> time;          ///< s of the record
  std::vector<double> acceleration;  ///< m/s²
  std::vector<double> velocity;      ///< m/s
  std::vector<double> displacement;  ///< m
  std::vector<double> arias;         ///< m/s, π/(2g) ∫ a² dt from the first sample on
};
MotionSeries motion_series(const MotionComponent& component, Baseline baseline);

/// x of an oscillator x'' + 2 ζ ω x' + ω² x = −a(t) that is at rest at the first sample, m. Exact for a(t) linear between samples (Nigam &
/// Jennings 1969), at forty places in a period, or at sixty-four between two samples; the same places for all of one time.
std::vector<double> oscillator_history(const std::vector<double>& time,
                                       const std::vector<double>& acceleration, double period,
                                       double damping);

/// Pseudo-acceleration ω² max |x| of oscillators x'' + 2 ζ ω x' + ω² x = −a(t) that are at rest at the first sample, m/s², one per period
/// (s). Exact for a(t) linear between samples (Nigam & Jennings 1969); the largest |x| is looked for at forty places in a period, or at
/// sixty-four between two samples.
std::vector<double> response_spectrum(const MotionSeries& series, const std::vector<double>& periods,
                                      double damping);

}  // namespace keyblock::loading
