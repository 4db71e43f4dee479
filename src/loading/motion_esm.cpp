#include <fmt/format.h>

#include "loading/motion_formats.h"

// ASCII files of the Engineering Strong Motion database, of ITACA, and of the Turkish TADAS (`HEADER_FORMAT: DYNA 1.2`): lines
// `KEY: value`, 64 in the version of today, then a sample per line. One component per file.
namespace keyblock::loading {
namespace {

bool matches_esm(const MotionText& text) {
  const HeaderKeys keys(text);
  return text.line(0).starts_with("EVENT_") && keys.line("NDATA") < text.size() &&
         text.line(0).find(':') != std::string_view::npos;
}

// The first line after the header that is no `KEY: value`.
std::size_t esm_data_line(const MotionText& text) {
  std::size_t k = 0;
  while (k < text.size() && text.line(k).find(':') != std::string_view::npos) ++k;
  return k;
}

MotionDirection find_esm_direction(const HeaderKeys& keys, std::string& label) {
  std::string_view stream = keys.value("STREAM:");
  if (stream.empty()) stream = keys.value("COMPONENT:");
  label = std::string(stream);
  const MotionDirection by_code = channel_code_direction(stream);
  if (by_code.stated()) return by_code;
  // "NSC" and "WEC" are N-S and W-E of a corrected record.
  if (stream.size() == 3 && (stream.back() == 'C' || stream.back() == 'U')) stream.remove_suffix(1);
  return parse_direction(stream);
}

std::vector<MotionComponent> read_esm(const MotionText& text, const MotionReading& /*reading*/) {
  const HeaderKeys keys(text);
  const std::string_view type = keys.value("DATA_TYPE:");
  if (!type.empty() && lower(type) != "acceleration")
    text.fail(keys.line("DATA_TYPE:"), 1, quoted_text(type), "`DATA_TYPE: ACCELERATION`");
  MotionComponent component = make_component(text, esm_format.name);
  component.event = fmt::format("{} {}", keys.value("EVENT_NAME:"), keys.value("EVENT_DATE_YYYYMMDD:"));
  component.station = fmt::format("{} {} {}", keys.value("NETWORK:"), keys.value("STATION_CODE:"),
                                  keys.value("STATION_NAME:"));
  component.dt = keys.time_step("SAMPLING_INTERVAL_S");
  const std::size_t points = keys.count("NDATA");
  const std::size_t unit_line = keys.required("UNITS:", "the unit of the samples");
  const auto unit = line_unit(text, unit_line);
  if (!unit) text.fail(unit_line, fmt::format("a unit of acceleration: {}", acceleration_units_text));
  const MotionDirection direction = find_esm_direction(keys, component.label);
  if (const auto depth = parse_number(keys.value("SENSOR_DEPTH_M:")); depth && *depth > 0.0)
    component.at_depth = true;
  std::size_t next = 0;
  set_samples(component, text.numbers(esm_data_line(text), points, 0, "samples", &next), *unit, direction);
  if (next < text.size()) text.fail(next, fmt::format("the end of the file after {} samples", points));
  if (!keys.value("PGA_CM/S^2").empty())
    compare_peak(component, keys.number("PGA_CM/S^2", "the peak acceleration") * 0.01);
  return {std::move(component)};
}

}  // namespace

const MotionFormat esm_format{"ESM or ITACA", matches_esm, read_esm};

}  // namespace keyblock::loading
