#include <fmt/format.h>

#include <algorithm>

#include "loading/fixed_columns.h"
#include "loading/motion_formats.h"

// Film records of the University of Southern California, volume 1, which are not corrected. Per channel: 13 lines of text, of which the
// first has `OF UNCORRECTED ACCELEROGRAM DATA OF`; integers, 7 lines of 16I5 or 5 lines of 20I4; reals, 7 lines of 8F10; and pairs of
// time and acceleration in columns of 8, 7, 7 … characters; then one line that ends the record. Integer 27 is the direction (degrees,
// 400 and 500 upwards, 600 downwards), 28 the number of points; real 5 is the unit, a fraction of g.
namespace keyblock::loading {
namespace {

constexpr std::string_view usc_title = "of uncorrected accelerogram data of";
constexpr std::size_t usc_text_lines = 13, usc_real_lines = 7, usc_station_line = 5;
constexpr std::size_t usc_direction = 26, usc_points = 27, usc_unit = 4;
constexpr std::size_t first_width = 8, other_width = 7, usc_real_width = 10, reals_per_line = 8;

/// How integers and pairs are laid out.
struct UscLayout {
  std::size_t integer_lines, integers_per_line, integer_width, numbers_per_line;
};

// In the layout of 20I4 the sixth line after the text has reals.
UscLayout layout_of(const MotionText& text, std::size_t first) {
  constexpr UscLayout usual{7, 16, 5, 10}, other{5, 20, 4, 8};
  const std::string_view line = text.line(first + usc_text_lines + other.integer_lines);
  return line.find('.') == std::string_view::npos ? usual : other;
}

MotionDirection usc_direction_of(const MotionText& text, std::size_t line, double stated) {
  MotionDirection direction;
  constexpr double vertical = 400.0, up = 500.0, down = 600.0;
  if (stated >= 0.0 && stated <= 360.0) {
    direction.azimuth = stated;
  } else if (stated == vertical || stated == up || stated == down) {
    direction.vertical = true;
    direction.downwards = stated == down;
  } else if (!(stated > down)) {
    text.fail(line, 1, fmt::format("the direction {}", stated), "0 to 360 degrees, 400, 500 or 600");
  }
  return direction;
}

AccelerationUnit usc_unit_of(const MotionText& text, std::size_t first, double fraction) {
  if (fraction > 0.0) return {fmt::format("{} g", fraction), fraction * standard_gravity};
  for (std::size_t k = first; k < first + usc_text_lines; ++k) {
    if (lower(text.line(k)).find("units of") == std::string::npos) continue;
    if (const auto unit = line_unit(text, k)) return *unit;
  }
  text.fail(first, "the unit of the samples, a fraction of g in the header");
}

MotionComponent read_usc_channel(const MotionText& text, std::size_t first, std::size_t& next) {
  MotionComponent component = make_component(text, usc_format.name);
  component.station = squeeze(text.line(first + usc_station_line).substr(0, 72));
  const UscLayout layout = layout_of(text, first);
  const std::size_t integers = first + usc_text_lines, reals = integers + layout.integer_lines;
  const auto integer = [&](std::size_t k) {
    return FixedColumns{layout.integer_width, layout.integer_width}.required(
        text, integers + k / layout.integers_per_line, k % layout.integers_per_line);
  };
  const auto points = text.count(integer(usc_points), 2);
  if (!points) text.fail(integers + 1, "the number of points, which the file must hold");
  const double fraction = FixedColumns{usc_real_width, usc_real_width}
                              .number(text, reals, usc_unit % reals_per_line)
                              .value_or(0.0);
  const AccelerationUnit unit = usc_unit_of(text, first, fraction);
  const MotionDirection direction = usc_direction_of(text, integers + 1, integer(usc_direction));
  component.label = direction.azimuth    ? fmt::format("{}", *direction.azimuth)
                    : direction.vertical ? (direction.downwards ? "down" : "up")
                                         : "";
  const std::size_t rows = reals + usc_real_lines;
  const std::vector<double> pairs = FixedColumns{first_width, other_width}.numbers(
      text, rows, 2 * *points, layout.numbers_per_line, "times and samples");
  const std::size_t lines = (2 * *points + layout.numbers_per_line - 1) / layout.numbers_per_line;
  set_pairs(
      text, pairs, [&](std::size_t k) { return rows + 2 * k / layout.numbers_per_line; }, unit, direction,
      component);
  next = rows + lines + 1;  // a line ends the record
  while (next < text.size() && trim(text.line(next)).empty()) ++next;
  return component;
}

bool matches_usc(const MotionText& text) {
  return lower(text.line(0)).find(usc_title) != std::string::npos;
}

std::vector<MotionComponent> read_usc(const MotionText& text, const MotionReading& /*reading*/) {
  std::vector<MotionComponent> components;
  for (std::size_t first = 0; first < text.size();) {
    if (lower(text.line(first)).find(usc_title) == std::string::npos)
      text.fail(first, "a line with `OF UNCORRECTED ACCELEROGRAM DATA OF`, which begins a channel");
    std::size_t next = first;
    components.push_back(read_usc_channel(text, first, next));
    first = next;
  }
  return components;
}

}  // namespace

const MotionFormat usc_format{"USC V1", matches_usc, read_usc};

}  // namespace keyblock::loading
