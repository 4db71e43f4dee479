#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "loading/ground_motion.h"
#include "loading/motion_file.h"

namespace keyblock::loading {

/// Which way a component acts: up, or along an azimuth.
struct ComponentDirection {
  bool vertical = false;  ///< positive upwards
  double azimuth = 0.0;   ///< degrees from north, clockwise; not used when vertical
};

/// What is done to the acceleration of the window after projection and before scaling. The equations of
/// motion are those relative to the base, so that a base that drifts does not disturb the result; correction
/// matters to those who compare the ground's own velocity and displacement.
enum class Baseline {
  none,    ///< as recorded (default)
  demean,  ///< less its mean: the ground's velocity is the same at the end as at the start
  linear,  ///< less c₀ + c₁ t, so that both velocity and displacement of the ground end where they began
  taper,   ///< times a cosine taper over the first and last 5 % of the window: starts and ends at zero
};

struct ProjectionOptions {
  double section_azimuth = 0.0;  ///< degrees from north of the +x axis
  /// From and to, s of the record; time restarts at 0 at its start. Default: the whole record.
  std::optional<std::pair<double, double>> window = std::nullopt;
  double scale = 1.0;
  Baseline baseline = Baseline::none;
};

/// The motion of the base in the section plane:
///
///     a_x = Σ a_i cos(azimuth_i − section azimuth),   a_y = Σ a_up
///
/// Components may differ in time step and length. Each is linear between its samples; the sum keeps the times
/// of all. A component that ends before the others is padded with zeros (it reaches zero one step after its
/// last sample, or one step before its first).
///
/// Throws InputError (key `window`) when the window is empty or reaches beyond the longest component.
GroundMotion project_motion(std::string name,
                            const std::vector<std::pair<MotionComponent, ComponentDirection>>& components,
                            const ProjectionOptions& options);

/// Rows (time s, acceleration m/s²). Two rows of the same time are a jump.
using AccelerationTable = std::vector<std::pair<double, double>>;

/// a(t) = amplitude · sin(2π frequency t) for a number of cycles (which may be fractional).
struct Sine {
  double amplitude = 0.0;  ///< m/s²
  double frequency = 0.0;  ///< Hz
  double cycles = 0.0;
};

/// A sine as a piecewise linear table, 1000 rows per cycle: off by at most 5e-6 of the amplitude, and with
/// every peak of a whole number of quarter cycles hit exactly. Throws InputError for a frequency or number of
/// cycles that is not positive and finite, or a table of more than ten million rows.
AccelerationTable sine_table(const Sine& sine);

/// A motion given by tables in x and y; an empty one is zero. Each is linear between rows and zero before its
/// first row and after its last. Throws InputError (keys `x`, `y`) for rows that do not ascend in time, start
/// before 0, or are not finite, and when both tables are empty.
GroundMotion table_motion(std::string name, const AccelerationTable& x, const AccelerationTable& y);

}  // namespace keyblock::loading
