#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::loading {

/// m/s² per unit.
struct AccelerationUnit {
  std::string name;  ///< "g", "cm/s2", "m/s2", "mm/s2", "in/s2", "ft/s2", "g/10", "mg", "%g" or "mgal"
  double in_si = 1.0;
};

/// What a unit measures. `unknown`: it looks like a unit, and is none of those that are understood.
enum class UnitKind { acceleration, velocity, displacement, unknown };

/// A word or some words of a text that are a unit, or look like one.
struct UnitMention {
  std::string words;   ///< as written, in small letters
  std::size_t at = 0;  ///< offset of its first character
  UnitKind kind = UnitKind::unknown;
  AccelerationUnit unit;  ///< of an acceleration
  /// Whether it can be nothing but a unit: `cm/s2`, and `g` after "in units of" or alone in brackets. Not so: `g` or `m` in passing.
  bool sure = false;
  bool after_number = false;  ///< as in `PGA 0.3 g` or `(x10 m/s2)`
  bool scaled = false;        ///< the number is a factor: `in 0.001 g`, `(1e-3 g)`
  bool last = false;          ///< no word follows
};

/// All units in a line. Spellings: `cm/sec/sec`, `cm/s^2`, `cm s-2`, `cm_s2`, `gal`, `centimeters per second squared` …
std::vector<UnitMention> unit_mentions(std::string_view line);

/// The unit of acceleration that fills `words`; absent for anything else.
std::optional<AccelerationUnit> acceleration_unit(std::string_view words);

/// The units that are understood, in words, for messages.
inline constexpr const char* acceleration_units_text = "g, cm/s2, gal, m/s2 or mm/s2";

class MotionText;

/// The unit of acceleration that a line names from column `from` on; absent when it names none. Throws InputError when the line names
/// two, one of another quantity, one that is not understood, one with a number before it, or announces a unit that does not follow.
std::optional<AccelerationUnit> line_unit(const MotionText& text, std::size_t line, std::size_t from = 0);

/// The same of a line with values in that unit, `Peak  -2080.5 mm/s/s`.
std::optional<AccelerationUnit> unit_of_values(const MotionText& text, std::size_t line);

/// Throws InputError where a line is about velocity or displacement, and not about acceleration.
void refuse_other_quantity(const MotionText& text, std::size_t line);

}  // namespace keyblock::loading
