#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "loading/motion_formats.h"

// K-NET and KiK-net (NIED, Japan): 17 lines `Key   value`, then counts of the digitizer, 8 to a line. One component per file.
//   Scale Factor      3920(gal)/6182761
// The counts hold the offset of the sensor: `Max. Acc. (gal)` of the header is the peak after the mean has been taken off.
namespace keyblock::loading {
namespace {

constexpr std::string_view scale_key = "Scale Factor", direction_key = "Dir.", memo_key = "Memo.";

// "3920(gal)/6182761" as m/s² per count.
AccelerationUnit scale_factor(const MotionText& text, const HeaderKeys& keys) {
  const std::size_t line = keys.required(scale_key, "the acceleration of a count");
  const std::string_view value = keys.value(scale_key);
  const std::size_t open = value.find('('), close = value.find(')'), slash = value.rfind('/');
  if (open < close && close != std::string_view::npos && slash != std::string_view::npos && slash > close) {
    const auto numerator = parse_number(value.substr(0, open));
    const auto denominator = parse_number(value.substr(slash + 1));
    const auto unit = acceleration_unit(value.substr(open + 1, close - open - 1));
    if (unit && numerator && denominator && *numerator > 0.0 && *denominator > 0.0)
      return {unit->name, *numerator / *denominator * unit->in_si};
  }
  text.fail(line, text.line(line).size() - value.size() + 1, quoted_text(value),
            "the acceleration of a count, as in `3920(gal)/6182761`");
}

// 1 to 3 are the sensors in the borehole of a KiK-net station, 4 to 6 those at the surface.
MotionDirection find_knet_direction(const MotionText& text, const HeaderKeys& keys,
                                    MotionComponent& component) {
  const std::size_t line = keys.required(direction_key, "the direction");
  const std::string_view value = keys.value(direction_key);
  constexpr const char* names[] = {"N-S", "E-W", "U-D"};
  component.label = std::string(value);
  if (value.size() == 1 && value[0] >= '1' && value[0] <= '6') {
    const int number = value[0] - '1';
    component.format = "KiK-net";
    component.at_depth = number < 3;
    component.label =
        fmt::format("{}, {}", names[number % 3], *component.at_depth ? "at depth" : "at the surface");
    return parse_direction(names[number % 3]);
  }
  const MotionDirection direction = parse_direction(value);
  if (!direction.stated() || parse_number(value))
    text.fail(line, text.line(line).size() - value.size() + 1, quoted_text(value), "N-S, E-W, U-D or 1 to 6");
  return direction;
}

std::size_t knet_points(const MotionText& text, const HeaderKeys& keys, double rate) {
  const double duration = keys.number("Duration Time(s)", "the duration in s");
  const auto points = text.count(std::round(duration * rate));
  if (points) return *points;
  text.fail(keys.line("Duration Time(s)"), 1, fmt::format("{} s at {} Hz", duration, rate),
            "a number of samples that the file can hold");
}

bool matches_knet(const MotionText& text) {
  const HeaderKeys keys(text);
  return keys.line("Origin Time") == 0 && keys.line(scale_key) < text.size();
}

std::vector<MotionComponent> read_knet(const MotionText& text, const MotionReading& /*reading*/) {
  const HeaderKeys keys(text);
  MotionComponent component = make_component(text, "K-NET");
  component.event = fmt::format("{}, M {}", keys.value("Origin Time"), keys.value("Mag."));
  component.station = std::string(keys.value("Station Code"));
  const double rate = keys.number("Sampling Freq(Hz)", "the samples per second");
  if (!(rate > 0.0) || !is_time_step(1.0 / rate))
    text.fail(keys.line("Sampling Freq(Hz)"), 1, fmt::format("{}", rate), "samples per second, 1e-6 to 1e9");
  component.dt = 1.0 / rate;
  const AccelerationUnit count = scale_factor(text, keys);
  const MotionDirection direction = find_knet_direction(text, keys, component);
  const std::size_t points = knet_points(text, keys, rate);
  const std::size_t memo = keys.required(memo_key, "what was noted, which ends the header");
  std::size_t next = 0;
  std::vector<double> samples = text.numbers(memo + 1, points, 0, "samples", &next);
  if (next < text.size()) text.fail(next, fmt::format("the end of the file after {} samples", points));
  const double mean =
      std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  for (double& sample : samples) sample -= mean;
  set_samples(component, std::move(samples), count, direction);
  component.file_unit = "cm/s2";
  component.file_unit_in_si = 0.01;
  component.processing = fmt::format("counts × {}; their mean, {:.4g} cm/s2, is taken off",
                                     keys.value(scale_key), mean * count.in_si / component.file_unit_in_si);
  const std::size_t peak = keys.line("Max. Acc.");
  if (peak < text.size())
    compare_peak(component, keys.number("Max. Acc. (gal)", "the peak") * component.file_unit_in_si,
                 0.0005 * component.file_unit_in_si);
  return {std::move(component)};
}

}  // namespace

const MotionFormat knet_format{"K-NET or KiK-net", matches_knet, read_knet};

}  // namespace keyblock::loading
