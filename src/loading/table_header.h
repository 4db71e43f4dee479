#pragma once
#include <optional>
#include <string>
#include <vector>

#include "loading/motion_direction.h"
#include "loading/motion_text.h"
#include "loading/motion_units.h"

namespace keyblock::loading {

/// What the names of a table say about a column.
struct TableColumn {
  std::string name;
  MotionDirection direction;
  UnitKind kind = UnitKind::acceleration;
  std::optional<AccelerationUnit> unit;  ///< absent when the name has none
};

struct TableHeader {
  double seconds = 1.0;  ///< per unit of the times
  bool time_unit_in_brackets = false;
  std::vector<TableColumn> columns;  ///< without that of the times
};

/// The names of the `count` columns of a table, of which the first one is time. `lines` are the lines that hold them, from the first
/// row upwards: none, one, or two where units have a line of their own. Names are parted by `;`, commas, tabs or blanks.
///
/// Throws InputError for a unit that is not understood, and where the first column is no time.
TableHeader read_table_header(const MotionText& text, const std::vector<std::size_t>& lines,
                              std::size_t count);

/// Whether a line, or a comment, has the names of `count` columns, of which the first one is a time.
bool names_columns(std::string_view line, std::size_t count);

/// Whether a line can be the names of `count` columns, whatever they are.
bool has_column_names(std::string_view line, std::size_t count);

/// A comment without its sign and without a key before a colon: `#DataSequence: Time U(+)`.
std::string_view comment_words(std::string_view line);

}  // namespace keyblock::loading
