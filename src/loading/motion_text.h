#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::loading {

struct MotionComponent;

/// The lines of a strong-motion file, with what its readers share. Lines count from 0 here and from 1 in
/// messages. A byte order mark at the beginning is left out.
class MotionText {
 public:
  MotionText(std::string file, std::string content);
  MotionText(const MotionText&) = delete;
  MotionText& operator=(const MotionText&) = delete;

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::size_t size() const { return lines_.size(); }
  /// Without line ending and trailing blanks; empty past the end.
  [[nodiscard]] std::string_view line(std::size_t k) const;
  /// First line ≥ `from` that contains `text` in any case; size() when there is none.
  [[nodiscard]] std::size_t find(std::string_view text, std::size_t from = 0) const;

  /// Reads `count` numbers from line `first` on, in columns of `width` characters; with width 0 numbers end at a
  /// blank, a comma, or where a sign that belongs to no exponent begins the next. `what` they are is for the message.
  /// `next_line` receives the line after the last one read. Throws InputError for anything that is no finite
  /// number, when the file ends too early, and when the last line read has more numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t first, std::size_t count, std::size_t width,
                                            const std::string& what, std::size_t* next_line = nullptr) const;

  /// `stated` as a number of lines or numbers that the file can hold: whole, from `least` to the length of the file in
  /// characters. Nothing else is a count.
  [[nodiscard]] std::optional<std::size_t> count(std::optional<double> stated, std::size_t least = 1) const;

  [[noreturn]] void fail(std::size_t line, std::size_t column, std::string found, std::string expected,
                         std::string hint = {}) const;
  [[noreturn]] void fail(std::size_t line, std::string expected) const;

 private:
  std::string file_;
  std::string content_;
  std::vector<std::string_view> lines_;
};

std::string_view trim(std::string_view text);
/// Runs of blanks become one blank.
std::string squeeze(std::string_view text);
std::string lower(std::string_view text);
/// A finite number that fills `text` but for blanks; Fortran's D exponents and leading + are understood.
std::optional<double> parse_number(std::string_view text);
/// The number that follows `key` in `text` (after any of " =:("), e.g. number_after("NPTS= 12", "NPTS").
std::optional<double> number_after(std::string_view text, std::string_view key);

/// Whether a step between samples is one: neither so short nor so long that times lose their meaning.
bool is_time_step(std::optional<double> seconds);
/// What is expected of one, in words.
inline constexpr const char* time_step_text = "the time step, 1e-9 to 1e6 s";

/// m/s² per unit for the spellings in use (g, cm/s2, cm/sec/sec, gal, m/s2 …); absent for any other word.
struct AccelerationUnit {
  std::string name;  ///< "g", "cm/s2" or "m/s2"
  double in_si = 1.0;
};
std::optional<AccelerationUnit> acceleration_unit(std::string_view word);

/// The direction in which a component is positive.
struct MotionDirection {
  std::optional<double> azimuth;  ///< degrees from north, clockwise
  bool vertical = false;
  bool downwards = false;  ///< vertical and positive downwards
};
/// From words as files have them: "360", "90 DEG", "N21E", "up", "DWN"; nothing is set for any others.
MotionDirection parse_direction(std::string_view words);

/// Stores samples given in `unit` and their direction, turned to positive upwards when positive downwards.
void set_samples(MotionComponent& component, std::vector<double> samples, const AccelerationUnit& unit,
                 const MotionDirection& direction);

/// One reader per format. `matches_…` looks at the content; `read_…` may throw InputError.
bool matches_smc(const MotionText& text);
bool matches_at2(const MotionText& text);
bool matches_csmip(const MotionText& text);
bool matches_cosmos(const MotionText& text);
bool matches_csv(const MotionText& text);
std::vector<MotionComponent> read_smc(const MotionText& text);
std::vector<MotionComponent> read_at2(const MotionText& text);
std::vector<MotionComponent> read_csmip(const MotionText& text);
std::vector<MotionComponent> read_cosmos(const MotionText& text);
std::vector<MotionComponent> read_csv(const MotionText& text);

}  // namespace keyblock::loading
