#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "loading/motion_formats.h"

// USGS strong-motion CD format: https://escweb.wr.usgs.gov/nsmp-data/smcfmt.html
namespace keyblock::loading {
namespace {

constexpr std::size_t smc_event_line = 3, text_lines = 11, integer_lines = 6, real_lines = 10;
constexpr std::size_t integer_count = 48, real_count = 50;
constexpr std::size_t integer_width = 10, real_width = 15, sample_width = 10;

// Positions in the integer and real headers; the first of each is the value that stands for "unknown".
constexpr std::size_t vertical_orientation = 12, horizontal_orientation = 13, comment_count = 15,
                      point_count = 16;
constexpr std::size_t sampling_rate = 1, largest_sample = 29, smallest_sample = 31;

// From the words of the text header, or else from the integers: 0 is up, 90 horizontal, 180 down.
MotionDirection find_smc_direction(const MotionComponent& component, const std::vector<double>& integers) {
  const MotionDirection named = parse_direction(component.label);
  if (named.vertical || named.azimuth) return named;
  if (integers[vertical_orientation] == 0.0) return parse_direction("up");
  if (integers[vertical_orientation] == 180.0) return parse_direction("down");
  if (integers[vertical_orientation] != 90.0) return {};
  return parse_direction(fmt::format("{}", integers[horizontal_orientation]));
}

void check_smc_peak(MotionComponent& component, const std::vector<double>& reals) {
  const double none = reals[0];
  if (reals[largest_sample] == none || reals[smallest_sample] == none) return;
  compare_peak(component, std::max(std::abs(reals[largest_sample]), std::abs(reals[smallest_sample])) *
                              component.file_unit_in_si);
}

bool matches_smc(const MotionText& text) {
  const std::string_view first = text.line(0);
  if (first.size() < 3 || first[0] < '0' || first[0] > '9' || first[1] != ' ') return false;
  return text.line(1).starts_with('*') && first.find_first_of("0123456789.,", 2) == std::string_view::npos;
}

std::vector<MotionComponent> read_smc(const MotionText& text, const MotionReading& /*reading*/) {
  if (lower(text.line(0)).find("accelerogram") == std::string::npos) {
    text.fail(0, "an accelerogram (SMC types 1 and 2), not velocity, displacement or spectra");
  }
  const std::vector<double> integers =
      text.numbers(text_lines, integer_count, integer_width, "integers of the header");
  const std::size_t real_start = text_lines + integer_lines;
  const std::vector<double> reals = text.numbers(real_start, real_count, real_width, "reals of the header");
  const auto points = text.count(integers[point_count]), comments = text.count(integers[comment_count], 0);
  if (!points)
    text.fail(text_lines + 2,
              "the number of points, which the file must hold, in the first ten columns, at least 1");
  if (!comments) text.fail(text_lines + 1, "the number of comment lines in the last ten columns");
  const double rate = reals[sampling_rate];
  if (rate == reals[0] || !(rate > 0.0) || !is_time_step(1.0 / rate)) {
    text.fail(real_start, real_width + 1, fmt::format("{}", rate),
              "the sampling rate in samples per second, 1e-6 to 1e9",
              "unevenly digitized records are not supported");
  }
  MotionComponent component = make_component(text, smc_format.name);
  component.event = squeeze(text.line(smc_event_line));
  for (std::size_t k = smc_event_line + 1; k < text_lines; ++k) {
    const std::string_view line = text.line(k);
    const std::size_t station = lower(line).find("station ="), direction = lower(line).find("component=");
    if (station < direction) component.station = squeeze(line.substr(station + 9, direction - station - 9));
    if (direction != std::string::npos) component.label = squeeze(line.substr(direction + 10));
  }
  component.dt = 1.0 / rate;
  const std::size_t data = real_start + real_lines + *comments;
  std::size_t next = 0;
  set_samples(component, text.numbers(data, *points, sample_width, "samples", &next), {"cm/s2", 0.01},
              find_smc_direction(component, integers));
  if (next < text.size()) text.fail(next, fmt::format("the end of the file after {} samples", *points));
  check_smc_peak(component, reals);
  return {std::move(component)};
}

}  // namespace

const MotionFormat smc_format{"USGS SMC", matches_smc, read_smc};

}  // namespace keyblock::loading
