#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace keyblock::loading {

/// One component of a recorded ground motion: the acceleration of one point in one direction, m/s².
struct MotionComponent {
  std::string file;
  std::string format;  ///< name of the file format, such as "PEER AT2"
  std::string event;
  std::string station;
  std::string label;  ///< direction as the file words it: "360", "up", "CHAN 1: 90 DEG"; may be empty
  bool vertical =
      false;  ///< acceleration is positive upwards; a record positive downwards is turned on reading
  std::optional<bool> at_depth;   ///< in a borehole, or at the surface; none: the file does not say
  std::optional<double> azimuth;  ///< degrees from north, clockwise; absent when vertical or not in the file

  double start = 0.0;                ///< s, time of the first sample; 0 unless the file has times
  double dt = 0.0;                   ///< s; 0 when the samples are not evenly spaced
  std::vector<double> times;         ///< s, one per sample, only when the samples are not evenly spaced
  std::vector<double> acceleration;  ///< m/s²
  std::string file_unit;             ///< of the file: "cm/s2", "g", "m/s2"
  double file_unit_in_si = 1.0;      ///< m/s² per unit of the file
  std::string processing;            ///< what the format asks for on reading and was done; may be empty
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

/// What the user states about a file. With `skip`, `column` or `dt` the file is read by hand, as numbers after `skip` lines, whatever
/// format it has.
struct MotionReading {
  std::optional<int> skip;  ///< lines before the numbers; default: those that begin with no number
  std::optional<int>
      column;  ///< counted from 1; default: with `dt` all numbers of a line one after the other, else the second
  std::optional<double> dt;  ///< s; default: times are in the first column
  std::string unit;          ///< required by hand; else for files that name none. Empty: not stated

  [[nodiscard]] bool by_hand() const { return skip || column || dt; }
};

/// Reads all acceleration components of a strong-motion file. The format is recognized by the content; the formats, and what is read of
/// each, are in docs/guide/loads.md. Samples are in m/s², those of vertical components positive upwards.
///
/// A unit is read from the file, and one that is not understood is refused. Where a file names none, `reading` must; an AT2 file is else
/// taken to be in g, with a note.
///
/// Throws InputError, with line and column, for a file that is of no known format, holds no acceleration, is cut short or longer than
/// it says, has a sample that is not a finite number, or has steps of less than 1e-9 s or more than 1e6 s. Samples are at most 1e9
/// m/s². Throws it, too, for what is no regular file, is larger than 200 MB, or is no text.
std::vector<MotionComponent> read_motion_file(const std::filesystem::path& path,
                                              const MotionReading& reading = {});

/// The names of the formats that are read, "USGS SMC, PEER AT2, …".
std::string motion_format_names();

}  // namespace keyblock::loading
