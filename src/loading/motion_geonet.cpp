#include <fmt/format.h>

#include <algorithm>

#include "loading/motion_formats.h"

// V1A and V2A files of GeoNet (GNS Science, New Zealand): three components one after the other, each with 16 lines of text, 40 integers,
// 60 reals, and the samples in columns of eight; V2A files have velocity and displacement after the acceleration.
namespace keyblock::loading {
namespace {

constexpr std::size_t geonet_text_lines = 16, geonet_integers = 40, geonet_reals = 60, geonet_width = 8;
constexpr std::size_t geonet_station_line = 2, geonet_event_line = 6;
// Positions in the headers, from 0.
constexpr std::size_t direction_integer = 27, digitized_points = 30, acceleration_points = 33,
                      velocity_points = 34, displacement_points = 35, interval_real = 25;

bool matches_geonet(const MotionText& text) {
  const std::string first = lower(text.line(0));
  return first.find("corrected accelerogram") != std::string::npos && first.find("gns") != std::string::npos;
}

// Line of the component's text that begins with `key`; absent when there is none.
std::optional<std::size_t> text_line(const MotionText& text, std::size_t first, std::string_view key) {
  for (std::size_t k = first; k < first + geonet_text_lines; ++k) {
    if (lower(trim(text.line(k))).starts_with(key)) return k;
  }
  return {};
}

// mm/s/s of `Acceleration:  Peak  -2080.5 mm/s/s at  23.28 s`; of raw data times the factor of `Raw readings in units of 1.00 mm/s/s`.
AccelerationUnit geonet_unit(const MotionText& text, std::size_t first) {
  const auto peak = text_line(text, first, "acceleration");
  const auto unit = peak ? unit_of_values(text, *peak) : std::nullopt;
  if (!unit) text.fail(peak.value_or(first), "the line `Acceleration:  Peak` with the unit of the samples");
  const auto raw = text_line(text, first, "raw readings");
  if (!raw) return *unit;
  const auto raw_unit = unit_of_values(text, *raw);
  const auto factor = number_after(text.line(*raw), "units of");
  if (!raw_unit || !factor || !(*factor > 0.0)) text.fail(*raw, "`Raw readings in units of 1.00 mm/s/s`");
  return {raw_unit->name, *factor * raw_unit->in_si};
}

MotionDirection find_geonet_direction(const MotionText& text, std::size_t first, double stated,
                                      std::string& label) {
  const auto line = text_line(text, first, "component");
  if (line) label = squeeze(text.line(*line).substr(std::string_view("component").size()));
  const MotionDirection direction = parse_direction(label.substr(0, label.find(' ')));
  return direction.stated() || label.empty() ? direction : parse_direction(fmt::format("{}", stated));
}

std::size_t geonet_count(const MotionText& text, std::size_t line, double stated, std::size_t least) {
  const auto count = text.count(stated, least);
  if (!count) text.fail(line, 1, fmt::format("{}", stated), "a number of samples that the file can hold");
  return *count;
}

MotionComponent read_geonet_component(const MotionText& text, std::size_t first, std::size_t& next) {
  MotionComponent component =
      make_component(text, lower(text.line(first)).starts_with("un") ? "GeoNet V1A" : "GeoNet V2A");
  component.station = squeeze(text.line(first + geonet_station_line));
  component.event = squeeze(text.line(first + geonet_event_line));
  const std::size_t integer_line = first + geonet_text_lines;
  const auto integers =
      text.numbers(integer_line, geonet_integers, geonet_width, "integers of the header", &next);
  const std::size_t real_line = next;
  const auto reals = text.numbers(real_line, geonet_reals, geonet_width, "reals of the header", &next);
  constexpr std::size_t values_per_line = 10;
  component.dt = reals[interval_real];
  if (!is_time_step(component.dt))
    text.fail(real_line + interval_real / values_per_line,
              1 + geonet_width * (interval_real % values_per_line), fmt::format("{}", component.dt),
              time_step_text);
  const std::size_t count_line = integer_line + acceleration_points / values_per_line;
  const double stated = integers[acceleration_points];
  const std::size_t points =
      geonet_count(text, count_line, stated != 0.0 ? stated : integers[digitized_points], 1);
  const AccelerationUnit unit = geonet_unit(text, first);
  const MotionDirection direction =
      find_geonet_direction(text, first, integers[direction_integer], component.label);
  set_samples(component, text.numbers(next, points, geonet_width, "samples", &next), unit, direction);
  for (const std::size_t position : {velocity_points, displacement_points}) {
    const std::size_t others = geonet_count(text, count_line, integers[position], 0);
    if (others > 0)
      static_cast<void>(
          text.numbers(next, others, geonet_width, "values of velocity or displacement", &next));
  }
  const auto peak_line = text_line(text, first, "acceleration");
  const auto peak = number_after(lower(text.line(*peak_line)), "peak");
  const double peak_unit = unit_of_values(text, *peak_line)->in_si;
  if (peak) compare_peak(component, *peak * peak_unit, 0.05 * peak_unit);
  return component;
}

std::vector<MotionComponent> read_geonet(const MotionText& text, const MotionReading& /*reading*/) {
  std::vector<MotionComponent> components;
  for (std::size_t first = 0; first < text.size();) {
    if (lower(text.line(first)).find("accelerogram") == std::string::npos)
      text.fail(first,
                "the first line of the next component, `Corrected accelerogram …`, or the end of the file");
    std::size_t next = first;
    components.push_back(read_geonet_component(text, first, next));
    first = next;
    while (first < text.size() && text.line(first).empty()) ++first;
  }
  return components;
}

}  // namespace

const MotionFormat geonet_format{"GeoNet V1A or V2A", matches_geonet, read_geonet};

}  // namespace keyblock::loading
