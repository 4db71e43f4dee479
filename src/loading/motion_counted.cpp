#include <algorithm>
#include <utility>

#include "loading/motion_formats.h"
#include "loading/text_table.h"

// Samples after a line with their number and their time step, in either order; lines of text may stand above it:
//   Synthetic record m/s2
//   400 0.01
namespace keyblock::loading {
namespace {

constexpr std::size_t most_text_lines = 20;
constexpr double longest_step = 1.0;  // s, of a record

struct CountedSize {
  std::size_t line = 0;
  std::size_t points = 0;
  double dt = 0.0;
};

// The first line of numbers, where it has a count and a step.
std::optional<CountedSize> counted_size(const MotionText& text) {
  for (std::size_t k = 0; k < std::min(most_text_lines, text.size()); ++k) {
    const std::string_view line = text.line(k);
    if (is_comment(line) || !row_separator(line)) continue;
    const auto fields = split_fields(line, *row_separator(line));
    if (fields.size() != 2) return {};
    // A row may have decimal commas, which such records never do.
    const auto first = parse_number(fields[0]), second = parse_number(fields[1]);
    if (!first || !second) return {};
    const auto points = text.count(std::max(*first, *second), 2);
    const double dt = std::min(*first, *second);
    if (!points || !is_time_step(dt) || dt >= longest_step) return {};
    return CountedSize{k, *points, dt};
  }
  return {};
}

// Only a file that holds just so many numbers is of this kind: two columns may begin alike.
bool matches_counted(const MotionText& text) {
  const auto size = counted_size(text);
  if (!size) return false;
  std::size_t numbers = 0;
  for (std::size_t k = size->line + 1; k < text.size(); ++k) {
    const std::string_view line = text.line(k);
    if (is_comment(line)) continue;
    const auto separator = row_separator(line);
    if (!separator) return false;
    numbers += split_fields(line, *separator).size();
  }
  return numbers == size->points;
}

std::vector<MotionComponent> read_counted(const MotionText& text, const MotionReading& reading) {
  const CountedSize size = *counted_size(text);
  MotionComponent component = make_component(text, counted_format.name);
  component.dt = size.dt;
  std::optional<AccelerationUnit> unit;
  for (std::size_t k = 0; k < size.line; ++k) {
    refuse_other_quantity(text, k);
    const auto named = line_unit(text, k);
    if (named && unit && named->in_si != unit->in_si) text.fail(k, "one unit of acceleration");
    if (named) unit = named;
  }
  if (!unit) unit = stated_unit(text, reading);
  if (!unit) refuse_without_unit(text, size.line);
  set_samples(component, text.numbers_to_end(size.line + 1, is_comment), *unit, {});
  return {std::move(component)};
}

}  // namespace

const MotionFormat counted_format{"number and step, then samples", matches_counted, read_counted};

}  // namespace keyblock::loading
