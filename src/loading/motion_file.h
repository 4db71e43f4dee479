#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keyblock::loading {

/// One component of a recorded ground motion: the acceleration of one point in one direction, m/s².
struct MotionComponent {
  std::string file;
  std::string format;  ///< "USGS SMC", "PEER AT2", "CSMIP V2", "COSMOS V2" or "CSV"
  std::string event;
  std::string station;
  std::string label;  ///< direction as the file words it: "360", "up", "CHAN 1: 90 DEG"; may be empty
  bool vertical =
      false;  ///< acceleration is positive upwards; a record positive downwards is turned on reading
  std::optional<double> azimuth;  ///< degrees from north, clockwise; absent when vertical or not in the file

  double start = 0.0;                ///< s, time of the first sample; 0 but for CSV
  double dt = 0.0;                   ///< s; 0 when the samples are not evenly spaced (CSV only)
  std::vector<double> times;         ///< s, one per sample, only when the samples are not evenly spaced
  std::vector<double> acceleration;  ///< m/s²
  std::string file_unit;             ///< as in the file: "cm/s2", "g", "m/s2"
  double file_unit_in_si = 1.0;      ///< m/s² per unit of the file
  std::vector<std::string> notes;    ///< what was assumed or does not agree, for the user

  [[nodiscard]] double time(std::size_t k) const {
    return times.empty() ? start + dt * static_cast<double>(k) : times[k];
  }
  [[nodiscard]] double end() const { return time(acceleration.size() - 1); }
  [[nodiscard]] double duration() const { return end() - time(0); }
  /// Index of the first sample of largest magnitude.
  [[nodiscard]] std::size_t peak_index() const;
};

/// Standard acceleration of gravity, exact by definition (3rd CGPM 1901), m/s².
inline constexpr double standard_gravity = 9.80665;

/// Reads all acceleration components of a strong-motion file. The format is recognized by the content:
///
/// - USGS SMC (versions 1 and 2): 11 lines of text, 48 integers, 50 reals, comments, samples 8 to a line in
/// columns
///   of ten; one component, cm/s².
/// - PEER AT2: lines of text of which one holds NPTS and DT, then samples; one component, the unit is in the
/// text
///   (g when it is not).
/// - CSMIP V2 ("Volume 2"): several channels, each with blocks of acceleration, velocity and displacement, of
/// which
///   the acceleration is taken.
/// - COSMOS V1/V2: likewise, one data section after the other, accelerations only.
/// - CSV: two columns, time (s) and acceleration, separated by comma, semicolon or blanks; lines that begin
/// with `#`
///   are comments; an optional header line, which begins with no number, names the unit (m/s2, cm/s2, gal, g), which
///   is m/s² when it names none. Times must ascend, within ±1e10 s, and may be uneven.
///
/// Throws InputError, with the line, for a file that is of none of these formats, holds no acceleration, is
/// cut short or longer than it says, has a sample that is not a finite number, is in another unit, or has steps of less
/// than 1e-9 s or more than 1e6 s. Samples are at most 1e9 m/s².
std::vector<MotionComponent> read_motion_file(const std::filesystem::path& path);

}  // namespace keyblock::loading
