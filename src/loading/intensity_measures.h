#pragma once
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "loading/ground_motion.h"
#include "loading/motion_file.h"
#include "loading/projection.h"

/// Intensities of a record as hazard curves have them: of both horizontal components, whichever way the section lies.
///
///   RotDpp: the pp-th percentile, over the angles θ = 0° … 179°, of the largest |u₁ cos θ + u₂ sin θ| over time (Boore 2010)
///
/// u is the acceleration (PGA), the velocity from rest (PGV), or ω² times the displacement of an oscillator of 5 % damping (SA).
namespace keyblock::loading {

/// Both horizontal components over one time, over the window and after the correction of the baseline: x is along north, y along east.
/// None unless there are two horizontal components at right angles, to 2°.
std::optional<GroundMotion> horizontal_motion(
    const std::vector<std::pair<MotionComponent, ComponentDirection>>& components,
    const ProjectionOptions& options);
/// Of files without a scenario, as recorded.
std::optional<GroundMotion> horizontal_pair(const std::vector<MotionComponent>& components);

struct RotatedMeasure {
  std::string name, unit;  ///< "PGA", "m/s2"
  double rotd50 = 0.0, rotd100 = 0.0;
};
/// PGA, PGV, SA(0.3), SA(1.0).
std::vector<RotatedMeasure> rotated_measures(const GroundMotion& horizontal);

/// RotD50 and RotD100 of a history of vectors.
std::pair<double, double> rotated(const std::vector<Vec2>& history);

/// RotD50 of a record, m/s² and m/s; no numbers where it has no two horizontal components.
struct HorizontalMeasures {
  double pga = std::numeric_limits<double>::quiet_NaN();
  double pgv = std::numeric_limits<double>::quiet_NaN();
  double sa_03 = std::numeric_limits<double>::quiet_NaN();  ///< at 0.3 s
  double sa_10 = std::numeric_limits<double>::quiet_NaN();  ///< at 1 s
};
HorizontalMeasures horizontal_measures(const GroundMotion& horizontal, double factor);

}  // namespace keyblock::loading
