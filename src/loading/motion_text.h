#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::loading {

/// The lines of a strong-motion file, with what its readers share. Lines count from 0 here and from 1 in
/// messages. A byte order mark at the beginning is left out; lines end with LF, CR LF or CR. Text that is no UTF-8 is taken for
/// Latin-1.
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

  /// Reads `count` numbers from line `first` on, in columns of `width` characters; with width 0, and in lines with tabs, numbers end
  /// at a blank, a comma, or where a sign that belongs to no exponent begins the next. `what` they are is for the message.
  /// `next_line` receives the line after the last one read. Throws InputError for anything that is no finite
  /// number, when the file ends too early or within the last number, and when the last line read has more numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t first, std::size_t count, std::size_t width,
                                            const std::string& what, std::size_t* next_line = nullptr) const;

  /// All numbers from line `first` to the end, as with width 0. Lines for which `skipped` holds are left out.
  [[nodiscard]] std::vector<double> numbers_to_end(std::size_t first,
                                                   bool (*skipped)(std::string_view)) const;

  /// `stated` as a number of lines or numbers that the file can hold: whole, from `least` to the length of the file in
  /// characters. Nothing else is a count.
  [[nodiscard]] std::optional<std::size_t> count(std::optional<double> stated, std::size_t least = 1) const;

  [[noreturn]] void fail(std::size_t line, std::size_t column, std::string found, std::string expected,
                         std::string hint = {}) const;
  [[noreturn]] void fail(std::size_t line, std::string expected) const;
  /// Of the file as a whole.
  [[noreturn]] void refuse(std::string found, std::string expected, std::string hint = {}) const;

 private:
  /// Adds the numbers of a line to `values` until there are `count`; `what` and `count` are for messages.
  void add_numbers(std::size_t line, std::size_t count, std::size_t width, const std::string& what,
                   std::vector<double>& values) const;

  /// Throws InputError when the file ends within the last of `values`, in its line `line`.
  void check_last_number(std::size_t line) const;

  std::string file_;
  std::string content_;
  std::vector<std::string_view> lines_;
};

/// Throws an InputError about the file as a whole.
[[noreturn]] void refuse_file(const std::string& file, std::string found, std::string expected,
                              std::string hint = {});

std::string_view trim(std::string_view text);
/// Runs of blanks become one blank.
std::string squeeze(std::string_view text);
std::string lower(std::string_view text);
/// A finite number that fills `text` except for blanks; Fortran's D exponents and leading + are understood.
std::optional<double> parse_number(std::string_view text);
/// The number that follows `key` in `text` (after any of " =:("), e.g. number_after("NPTS= 12", "NPTS").
std::optional<double> number_after(std::string_view text, std::string_view key);

/// The width of a column in the last Fortran format of `text`: 10 of (8f10.6), 8 of (10I8), 13 of (6F13.6); absent when it has none.
std::optional<std::size_t> column_width(std::string_view text);

/// Text for a message: in quotes, cut when it is long.
std::string quoted_text(std::string_view text);

/// Whether a step between samples is one: neither so short nor so long that times lose their meaning.
bool is_time_step(std::optional<double> seconds);
/// What is expected of one, in words.
inline constexpr const char* time_step_text = "the time step, 1e-9 to 1e6 s";

}  // namespace keyblock::loading
