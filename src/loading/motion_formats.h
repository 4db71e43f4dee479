#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "loading/motion_direction.h"
#include "loading/motion_file.h"
#include "loading/motion_text.h"
#include "loading/motion_units.h"

namespace keyblock::loading {

/// A file format of ground motions. Each has a source file of its own, motion_NAME.cpp.
struct MotionFormat {
  const char* name;  ///< for people
  /// Whether a file is of this format, by its content. Damaged files are, too, as long as one can tell.
  bool (*matches)(const MotionText& text);
  /// Throws InputError. `reading` has the unit that the user states, for formats in which a file may name none.
  std::vector<MotionComponent> (*read)(const MotionText& text, const MotionReading& reading);
};

extern const MotionFormat smc_format, csmip_format, cosmos_format, knet_format, esm_format, geonet_format,
    afad_format, cwa_format, usc_format, bhrc_format, unam_format, at2_format, counted_format, table_format;

/// Reads a text of numbers whose layout the user states.
std::vector<MotionComponent> read_by_hand(const MotionText& text, const MotionReading& reading);

/// What most readers begin with.
MotionComponent make_component(const MotionText& text, const char* format);

/// Stores samples given in `unit` and their direction, turned to positive upwards when positive downwards.
void set_samples(MotionComponent& component, std::vector<double> samples, const AccelerationUnit& unit,
                 const MotionDirection& direction);

/// The unit that the user states; absent when none is. Throws InputError for one that is not understood.
std::optional<AccelerationUnit> stated_unit(const MotionText& text, const MotionReading& reading);

/// Throws InputError for a file that names no unit where `line` is the first that could: it says which key names it.
[[noreturn]] void refuse_without_unit(const MotionText& text, std::size_t line);

/// Adds a note when the largest sample is not what the header states, in m/s², rounded by at most `rounding`.
void compare_peak(MotionComponent& component, double stated, double rounding = 0.0);

/// The values of a header of lines `KEY: value` or `KEY  value`.
class HeaderKeys {
 public:
  explicit HeaderKeys(const MotionText& text) : text_(text) {}
  /// Line of the first one that begins with `key`, in any case, among the first hundred; size() of the text when there is none.
  [[nodiscard]] std::size_t line(std::string_view key) const;
  /// What follows the key and a colon; empty when there is no such line.
  [[nodiscard]] std::string_view value(std::string_view key) const;
  /// As a number. Throws InputError when the line is missing or has none; `what` it is, in words.
  [[nodiscard]] double number(std::string_view key, const std::string& what) const;
  /// A number of samples that the file can hold.
  [[nodiscard]] std::size_t count(std::string_view key) const;
  /// A time step in s.
  [[nodiscard]] double time_step(std::string_view key) const;
  /// Line of a key that must be there.
  [[nodiscard]] std::size_t required(std::string_view key, const std::string& what) const;

 private:
  const MotionText& text_;
};

}  // namespace keyblock::loading
