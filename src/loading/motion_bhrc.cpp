#include <algorithm>

#include "loading/fixed_columns.h"
#include "loading/motion_formats.h"

// Records of the Building and Housing Research Center (BHRC), Iran, volume 1. Per channel: 13 lines of text, the first of which begins
// with `* VOL1DS`; 7 lines of integers, 7 of reals; samples, ten in a line of 13 characters each, in g/10; one line that ends the record.
// Of the text, line 5 has the component (L, T or V), line 8 after `Station` latitude, longitude, height and the azimuths of L and T, line
// 11 the number of points and the duration.
namespace keyblock::loading {
namespace {

constexpr std::size_t bhrc_text_lines = 13, bhrc_number_lines = 14, bhrc_per_line = 10, bhrc_width = 13;
constexpr std::size_t component_line = 4, place_line = 7, size_line_of_text = 10;
constexpr std::size_t azimuth_of_l = 3, azimuth_of_t = 4;

// All numbers of a text, whatever stands between them.
std::vector<double> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  while (!text.empty()) {
    const std::size_t begin = text.find_first_of("0123456789.+-");
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    std::size_t end = std::min(text.find_first_not_of("0123456789.", 1), text.size());
    if (const auto number = parse_number(text.substr(0, end))) numbers.push_back(*number);
    text.remove_prefix(end);
  }
  return numbers;
}

bool begins_channel(const MotionText& text, std::size_t line) {
  return lower(text.line(line)).starts_with("* vol");
}

MotionDirection bhrc_direction(const MotionText& text, std::size_t first, std::string& label) {
  label = squeeze(text.line(first + component_line));
  MotionDirection direction;
  const std::string word = lower(label);
  if (word == "v") {
    direction.vertical = true;
    return direction;
  }
  const std::size_t line = first + place_line;
  const std::string_view place = text.line(line);
  const std::size_t at = lower(place).find("station");
  const auto numbers = at == std::string::npos ? std::vector<double>{} : numbers_in(place.substr(at));
  if ((word != "l" && word != "t") || numbers.size() <= azimuth_of_t)
    text.fail(word == "l" || word == "t" ? line : first + component_line,
              "a component L, T or V, and the azimuths of L and T after `Station`");
  direction.azimuth = numbers[word == "l" ? azimuth_of_l : azimuth_of_t];
  return direction;
}

AccelerationUnit bhrc_unit(const MotionText& text, std::size_t first) {
  for (std::size_t k = first + size_line_of_text; k < first + bhrc_text_lines; ++k) {
    if (const auto unit = line_unit(text, k)) return *unit;
  }
  return {"g/10", standard_gravity / 10.0};
}

MotionComponent read_bhrc_channel(const MotionText& text, std::size_t first, std::size_t& next) {
  MotionComponent component = make_component(text, bhrc_format.name);
  const std::string_view place = text.line(first + place_line);
  component.station = squeeze(place.substr(0, std::min(lower(place).find("station"), place.size())));
  const std::size_t size_at = first + size_line_of_text;
  const auto size = numbers_in(text.line(size_at));
  const auto points = size.empty() ? std::nullopt : text.count(size.front(), 2);
  if (!points || size.size() < 2)
    text.fail(size_at, "the number of points, which the file must hold, and the duration");
  const double dt = size[1] / static_cast<double>(*points - 1);
  if (!is_time_step(dt)) text.fail(size_at, time_step_text);
  component.dt = dt;
  const MotionDirection direction = bhrc_direction(text, first, component.label);
  const std::size_t rows = first + bhrc_text_lines + bhrc_number_lines;
  set_samples(component,
              FixedColumns{bhrc_width, bhrc_width}.numbers(text, rows, *points, bhrc_per_line, "samples"),
              bhrc_unit(text, first), direction);
  next = rows + (*points + bhrc_per_line - 1) / bhrc_per_line + 1;
  while (next < text.size() && trim(text.line(next)).empty()) ++next;
  return component;
}

bool matches_bhrc(const MotionText& text) {
  constexpr std::size_t comp_line = 6;
  return begins_channel(text, 0) && lower(text.line(comp_line)).starts_with("comp");
}

std::vector<MotionComponent> read_bhrc(const MotionText& text, const MotionReading& /*reading*/) {
  if (!lower(text.line(0)).starts_with("* vol1ds"))
    text.fail(0, "a file of volume 1, which begins with `* VOL1DS`");
  std::vector<MotionComponent> components;
  for (std::size_t first = 0; first < text.size();) {
    if (!begins_channel(text, first)) text.fail(first, "a line `* VOL1DS`, which begins a channel");
    std::size_t next = first;
    components.push_back(read_bhrc_channel(text, first, next));
    first = next;
  }
  return components;
}

}  // namespace

const MotionFormat bhrc_format{"BHRC V1", matches_bhrc, read_bhrc};

}  // namespace keyblock::loading
