#include "loading/fixed_columns.h"

#include <fmt/format.h>

#include <algorithm>

#include "loading/motion_formats.h"
#include "loading/text_table.h"

namespace keyblock::loading {

std::size_t FixedColumns::begin(std::size_t column) const {
  return column == 0 ? 0 : first_width + (column - 1) * width;
}

std::optional<double> FixedColumns::number(const MotionText& text, std::size_t line,
                                           std::size_t column) const {
  const std::string_view row = text.line(line);
  const std::size_t at = begin(column);
  if (at >= row.size()) return {};
  return parse_number(row.substr(at, column == 0 ? first_width : width));
}

double FixedColumns::required(const MotionText& text, std::size_t line, std::size_t column) const {
  const auto found = number(text, line, column);
  if (!found)
    text.fail(line, begin(column) + 1, quoted_text(text.line(line)),
              fmt::format("a number in column {} of {} characters", column + 1, width));
  return *found;
}

std::vector<double> FixedColumns::numbers(const MotionText& text, std::size_t first, std::size_t count,
                                          std::size_t per_line, const std::string& what) const {
  std::vector<double> values;
  values.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t line = first + k / per_line, column = k % per_line;
    const auto found = number(text, line, column);
    if (!found)
      text.fail(std::min(line, text.size() - 1), begin(column) + 1, fmt::format("{} {}", k, what),
                fmt::format("{} {}, {} in a line", count, what, per_line));
    values.push_back(*found);
  }
  return values;
}

void set_pairs(const MotionText& text, const std::vector<double>& pairs,
               const std::function<std::size_t(std::size_t)>& line, const AccelerationUnit& unit,
               const MotionDirection& direction, MotionComponent& component) {
  TextTable table;
  table.columns.resize(1);
  std::vector<double> samples;
  for (std::size_t k = 0; 2 * k + 1 < pairs.size(); ++k) {
    table.columns[0].push_back(pairs[2 * k]);
    table.lines.push_back(line(k));
    samples.push_back(pairs[2 * k + 1]);
  }
  set_times(text, table, 1.0, component);
  set_samples(component, std::move(samples), unit, direction);
}

}  // namespace keyblock::loading
