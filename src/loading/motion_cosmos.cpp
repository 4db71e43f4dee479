#include <fmt/format.h>

#include <cmath>

#include "loading/motion_file.h"
#include "loading/motion_text.h"

// COSMOS strong-motion data format 1.20 (Consortium of Organizations for Strong-Motion Observation Systems,
// 2001). A file is a row of sections, each: 13 lines of text; integer header; real header; comments; samples;
// end line.
namespace keyblock::loading {
namespace {

constexpr std::size_t event_line = 1, station_line = 4;  // of the text of a section

// Positions in the headers (the format counts from 1).
constexpr std::size_t integer_azimuth = 53;
constexpr std::size_t real_recorded_interval = 33;   // s
constexpr std::size_t real_processed_interval = 61;  // ms, of the series in this file
constexpr double unknown = -999.0, azimuth_up = 400.0, azimuth_down = 401.0;

// A line `100 Real-header values follow on  17 lines, Format= (6F13.6)` announces numbers.
struct Announcement {
  std::size_t count = 0, width = 0;
};

Announcement read_announcement(const MotionText& text, std::size_t line) {
  const std::string words = squeeze(text.line(line));
  const auto count = text.count(parse_number(std::string_view(words).substr(0, words.find(' '))));
  if (!count) text.fail(line, "a number of values, which the file must hold, at the start of the line");
  Announcement announcement{*count, 0};
  // The width stands between the letter and the point of (6F13.6), or ends the word: (10I8).
  const std::size_t open = words.rfind('(');
  const std::size_t letter = words.find_first_of("FEGIfegi", open == std::string::npos ? words.size() : open);
  if (letter != std::string::npos) {
    const std::size_t end = words.find_first_not_of("0123456789", letter + 1);
    const auto width =
        text.count(parse_number(std::string_view(words).substr(letter + 1, end - letter - 1)), 0);
    announcement.width = width.value_or(0);
  }
  return announcement;
}

std::size_t require(const MotionText& text, std::string_view words, std::size_t from) {
  const std::size_t line = text.find(words, from);
  if (line == text.size()) {
    text.fail(text.size() - 1, 0, "the end of the file", fmt::format("a line with `{}`", words),
              "the file may have been cut short");
  }
  return line;
}

double time_step(const MotionText& text, std::size_t line, const std::vector<double>& reals) {
  const auto value = [&](std::size_t k) { return k < reals.size() && reals[k] != unknown ? reals[k] : 0.0; };
  const double processed = value(real_processed_interval) / 1000.0;
  const double step = processed > 0.0 ? processed : value(real_recorded_interval);
  if (is_time_step(step)) return step;
  text.fail(line,
            fmt::format("a real header with the sample interval (values 62 or 34): {}", time_step_text));
}

AccelerationUnit section_unit(const MotionText& text, std::size_t line) {
  const std::string words = lower(text.line(line));
  const std::size_t at = words.find("units=");
  if (at != std::string::npos) {
    const std::string rest = words.substr(at + 6);
    if (const auto unit = acceleration_unit(std::string_view(rest).substr(0, rest.find_first_of("(,"))))
      return *unit;
  }
  text.fail(line, "a unit of acceleration, as in `units=cm/sec2`");
}

std::size_t data_line(const MotionText& text, std::size_t from) {
  for (std::size_t k = from; k < text.size(); ++k) {
    const std::string line = lower(text.line(k));
    if (line.find("pts, approx") != std::string::npos || line.find("pts approx") != std::string::npos)
      return k;
  }
  return require(text, "pts, approx", from);
}

MotionDirection section_direction(const std::vector<double>& integers) {
  const double azimuth = integers.size() > integer_azimuth ? integers[integer_azimuth] : unknown;
  if (azimuth == azimuth_up) return parse_direction("up");
  if (azimuth == azimuth_down) return parse_direction("down");
  return parse_direction(fmt::format("{}", azimuth));
}

// The words between `Chan 1:` and the next parenthesis.
std::string section_label(const MotionText& text, std::size_t first, std::size_t end) {
  const std::size_t line = text.find("chan ", first);
  if (line >= end) return {};
  std::string_view words = text.line(line);
  words = words.substr(lower(words).find("chan "));
  return squeeze(words.substr(0, words.find('(')));
}

}  // namespace

bool matches_cosmos(const MotionText& text) {
  return lower(text.line(0)).find("(format v") != std::string::npos &&
         text.find("integer-header values follow") < text.size();
}

std::vector<MotionComponent> read_cosmos(const MotionText& text) {
  std::vector<MotionComponent> components;
  for (std::size_t first = 0; first < text.size();) {
    const std::size_t integer_line = require(text, "integer-header values follow", first);
    const Announcement integer_size = read_announcement(text, integer_line);
    const auto integers =
        text.numbers(integer_line + 1, integer_size.count, integer_size.width, "integers of the header");
    const std::size_t real_line = require(text, "real-header values follow", integer_line);
    const Announcement real_size = read_announcement(text, real_line);
    std::size_t next = 0;
    const auto reals =
        text.numbers(real_line + 1, real_size.count, real_size.width, "reals of the header", &next);
    const std::size_t line = data_line(text, next);
    const bool is_acceleration = lower(text.line(line)).find("accel") != std::string::npos;
    if (is_acceleration) {
      MotionComponent component;
      component.file = text.file();
      component.format = "COSMOS V2";
      component.dt = time_step(text, real_line, reals);
      component.event = squeeze(text.line(first + event_line));
      const std::string_view station = text.line(first + station_line);
      const std::size_t code = station.find("Code:");
      component.station = squeeze(code == std::string_view::npos ? station : station.substr(code + 5));
      component.label = section_label(text, first + station_line + 1, integer_line);
      const AccelerationUnit unit = section_unit(text, line);
      const Announcement size = read_announcement(text, line);
      set_samples(component, text.numbers(line + 1, size.count, size.width, "samples", &next), unit,
                  section_direction(integers));
      components.push_back(std::move(component));
    }
    first = require(text, "end-of-data", is_acceleration ? next : line) + 1;
  }
  if (components.empty()) text.fail(0, "a file with a section of acceleration");
  return components;
}

}  // namespace keyblock::loading
