#pragma once
#include <string>
#include <vector>

#include "loading/ground_motion.h"
#include "loading/motion_file.h"

namespace keyblock::loading {

/// What engineers compare records by. All integrals are exact for acceleration linear between samples.
struct MotionMeasures {
  double peak = 0.0;       ///< m/s², of largest magnitude, with its sign (PGA)
  double peak_time = 0.0;  ///< s
  double peak_velocity =
      0.0;  ///< m/s, largest |∫a dt| from rest at the first sample, no baseline correction (PGV)
  double final_velocity = 0.0;     ///< m/s, ∫a dt over the whole record; far from 0: the record drifts
  double arias_intensity = 0.0;    ///< m/s, π/(2g) ∫a² dt (Arias 1970)
  double absolute_velocity = 0.0;  ///< m/s, ∫|a| dt (cumulative absolute velocity, CAV; EPRI 1988)
  double significant_duration =
      0.0;  ///< s, between 5 % and 95 % of the Arias intensity (Trifunac & Brady 1975)
};
MotionMeasures measure(const MotionComponent& component);

/// The same of the motion of the base in the section, over its first `duration` seconds: what a stage applies.
struct ShakingMeasures {
  double peak = 0.0;  ///< m/s², largest |a| (PGA)
  double peak_velocity =
      0.0;  ///< m/s, largest |∫a dt| from rest at the start (PGV); between samples where v·a changes sign
  double arias_intensity = 0.0;  ///< m/s, sum of both components: π/(2g) ∫|a|² dt
};
ShakingMeasures measure(const GroundMotion& motion, double scale, double duration);
/// The same of one direction of it: along the section, or upwards.
ShakingMeasures measure_along(Vec2 direction, const GroundMotion& motion, double scale, double duration);

/// s, 2π ∫|a| dt / ∫|da|, the period of a motion by the way that its acceleration goes: that of a sine, and in a record that of what is
/// strong. A jump counts as far as it goes. 0 where nothing changes.
double mean_period(const GroundMotion& motion);

/// g. A peak outside of this range is not that of a record of an earthquake, or it is in another unit.
inline constexpr double least_usual_peak = 1e-4, most_usual_peak = 3.0;

/// How far a motion is from rest where it starts and ends: |a| there, m/s², where it is more than a twentieth of the peak; else 0.
struct EndJumps {
  double start = 0.0, end = 0.0, peak = 0.0;
};
EndJumps end_jumps(const GroundMotion& motion);
EndJumps end_jumps(const MotionComponent& component);
/// "starts with a jump of 0.125 m/s2 and ends with one of 0.08 m/s2, 26 and 17 % of its peak"; empty when it does neither.
std::string jumps_text(const EndJumps& jumps);

/// The samples from one time to another, s of the record. Throws InputError when there are fewer than two.
MotionComponent cut_out(MotionComponent component, double from, double to);

/// What is told of a component beside its numbers: an unusual peak, jumps at its ends, what was assumed on reading.
std::vector<std::string> motion_notes(const MotionComponent& component);

/// What files hold, for people: one paragraph per component with its notes, then what two horizontal ones have together
/// (intensity_measures.h).
std::string describe_motion(const std::vector<MotionComponent>& components);

/// A picture as an SVG document. Per component: acceleration, velocity and displacement over time, response spectra of 5 % damping, and
/// the build-up of the Arias intensity, each as recorded and after each way of correcting the baseline.
std::string plot_motion_svg(const std::vector<MotionComponent>& components);

}  // namespace keyblock::loading
