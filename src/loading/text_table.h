#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loading/motion_file.h"
#include "loading/motion_text.h"

namespace keyblock::loading {

/// Rows of numbers in columns.
struct TextTable {
  std::vector<std::vector<double>> columns;
  std::vector<std::size_t> lines;  ///< of the rows
};

/// Whether a line is blank or begins with #, %, ! or //.
bool is_comment(std::string_view line);

/// The sign between the fields of a row of numbers: ';', ',', or ' ' for blanks and tabs. Absent when the line is no such row. Between
/// fields that `;` or blanks part, decimal commas are understood: `0,01;1,5`.
std::optional<char> row_separator(std::string_view line);

/// Fields of a line, without blanks at their ends.
std::vector<std::string_view> split_fields(std::string_view line, char separator);

/// All rows from line `first` on, comments left out. Throws InputError, with line and column, for a field that is no finite number, for
/// a row with more or fewer columns than the first one, and where some numbers have decimal commas and others decimal points.
TextTable read_rows(const MotionText& text, std::size_t first);

/// Times of `component` from the first column, in units of `seconds`. Throws InputError when they do not ascend, or are
/// beyond ±1e10 s.
void set_times(const MotionText& text, const TextTable& table, double seconds, MotionComponent& component);

}  // namespace keyblock::loading
