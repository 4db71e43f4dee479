#include <fmt/format.h>

#include <algorithm>

#include "loading/motion_formats.h"
#include "loading/text_table.h"

// Any text of numbers, by what the user states about it.
namespace keyblock::loading {
namespace {

void read_column(const MotionText& text, const MotionReading& reading, std::size_t start,
                 const AccelerationUnit& unit, MotionComponent& component) {
  TextTable table = read_rows(text, start);
  const auto column = static_cast<std::size_t>(std::max(reading.column.value_or(2), 0));
  if (column < 1 || column > table.columns.size())
    text.refuse(fmt::format("column = {}, and {} columns", column, table.columns.size()),
                "the number of a column, counted from 1");
  if (!reading.dt && column == 1)
    text.refuse("column = 1, and no dt", "times in column 1 and samples in another column, or dt");
  if (!reading.dt) set_times(text, table, 1.0, component);
  set_samples(component, std::move(table.columns[column - 1]), unit, {});
}

// The first line that begins with a number.
std::size_t first_number(const MotionText& text) {
  std::size_t k = 0;
  for (; k < text.size(); ++k) {
    const std::string_view line = trim(text.line(k));
    if (is_comment(line)) continue;
    const std::string_view start = line.substr(0, line.find_first_of(" \t,;"));
    if (start.find_first_not_of("0123456789+-.eEdD") == std::string_view::npos &&
        start.find_first_of("0123456789") != std::string_view::npos)
      break;
  }
  return k;
}

}  // namespace

std::vector<MotionComponent> read_by_hand(const MotionText& text, const MotionReading& reading) {
  const auto unit = stated_unit(text, reading);
  if (!unit)
    text.refuse("no unit, for a file that is read by skip, column and dt", "the unit of the samples");
  const auto skip = static_cast<std::size_t>(std::max(reading.skip.value_or(0), 0));
  const std::size_t start = reading.skip ? skip : first_number(text);
  if (start >= text.size())
    text.refuse(fmt::format("{} lines, and no numbers after {} of them", text.size(), skip),
                "lines of numbers");
  MotionComponent component = make_component(text, "text, by hand");
  if (reading.dt && !reading.column) {
    set_samples(component, text.numbers_to_end(start, is_comment), *unit, {});
  } else {
    read_column(text, reading, start, *unit, component);
  }
  if (reading.dt) {
    if (!is_time_step(reading.dt)) text.refuse(fmt::format("dt = {}", *reading.dt), time_step_text);
    component.dt = *reading.dt;
  }
  if (component.acceleration.size() < 2) text.refuse("fewer than two samples", "a record");
  return {std::move(component)};
}

}  // namespace keyblock::loading
