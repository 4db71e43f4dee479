#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "loading/motion_formats.h"

// COSMOS strong-motion data format 1.20 (Consortium of Organizations for Strong-Motion Observation Systems,
// 2001). A file is a row of sections, each: 13 lines of text; integer header; real header; comments; samples;
// end line.
namespace keyblock::loading {
namespace {

constexpr std::size_t event_line = 1, station_line = 4;  // of the text of a section

// Positions in the headers (the format counts from 1).
constexpr std::size_t integer_unit = 2, integer_azimuth = 53;
constexpr std::size_t real_recorded_interval = 33;   // s
constexpr std::size_t real_processed_interval = 61;  // ms, of the series in this file
constexpr std::size_t real_peak = 63;
constexpr double unknown = -999.0, azimuth_up = 400.0, azimuth_down = 401.0, azimuth_vertical = 402.0;

// A line `100 Real-header values follow on  17 lines, Format= (6F13.6)` announces numbers.
struct Announcement {
  std::size_t count = 0, width = 0;
};

Announcement read_announcement(const MotionText& text, std::size_t line) {
  const std::string words = squeeze(text.line(line));
  const auto count = text.count(parse_number(std::string_view(words).substr(0, words.find(' '))));
  if (!count) text.fail(line, "a number of values, which the file must hold, at the start of the line");
  return {*count, column_width(words).value_or(0)};
}

// Whether a line is an end mark or begins the next section.
bool ends_section(const MotionText& text, std::size_t line) {
  const std::string words = lower(text.line(line));
  return words.find("end-of-data") != std::string::npos || words.find("end of data") != std::string::npos ||
         words.find("(format v") != std::string::npos;
}

// The line with one of `words`, which mean the same, in the section of line `from`.
std::size_t require(const MotionText& text, std::initializer_list<std::string_view> words, std::size_t from) {
  const std::string expected = fmt::format("a line with `{}`", *words.begin());
  for (std::size_t k = from; k < text.size(); ++k) {
    const std::string line = lower(text.line(k));
    if (std::any_of(words.begin(), words.end(),
                    [&](std::string_view w) { return line.find(w) != std::string::npos; }))
      return k;
    if (k > from && ends_section(text, k)) text.fail(k, expected + " before this one");
  }
  text.fail(text.size() - 1, 0, "the end of the file", expected, "the file may have been cut short");
}

double time_step(const MotionText& text, std::size_t line, const std::vector<double>& reals) {
  const auto value = [&](std::size_t k) { return k < reals.size() && reals[k] != unknown ? reals[k] : 0.0; };
  const double processed = value(real_processed_interval) / 1000.0;
  const double step = processed > 0.0 ? processed : value(real_recorded_interval);
  if (is_time_step(step)) return step;
  text.fail(line,
            fmt::format("a real header with the sample interval (values 62 or 34): {}", time_step_text));
}

// Codes of units in the integer header; absent for those that are no acceleration or are not known.
std::optional<AccelerationUnit> coded_unit(double code) {
  const std::pair<double, const char*> known[] = {
      {2.0, "g"}, {4.0, "cm/s2"}, {7.0, "in/s2"}, {10.0, "gal"}, {11.0, "mg"}};
  for (const auto& [number, name] : known) {
    if (code == number) return acceleration_unit(name);
  }
  return {};
}

AccelerationUnit section_unit(const MotionText& text, std::size_t line, const std::vector<double>& integers) {
  const std::size_t units = lower(text.line(line)).find("units");
  const auto named = units == std::string::npos ? std::nullopt : line_unit(text, line, units);
  const auto coded = integers.size() > integer_unit ? coded_unit(integers[integer_unit]) : std::nullopt;
  if (named && coded && named->in_si != coded->in_si)
    text.fail(line, fmt::format("{}, as the integer header says in its value 3", coded->name));
  if (!named && !coded) text.fail(line, "a unit of acceleration, as in `units=cm/sec2`");
  return named ? *named : *coded;
}

// By the integer header, where 0 is no azimuth; else by the code of the channel in a comment `|<SCNL>BMR.BNZ.AK.--`.
MotionDirection section_direction(const MotionText& text, std::size_t first, std::size_t end,
                                  const std::vector<double>& integers) {
  const double azimuth = integers.size() > integer_azimuth ? integers[integer_azimuth] : unknown;
  if (azimuth == azimuth_up || azimuth == azimuth_vertical) return parse_direction("up");
  if (azimuth == azimuth_down) return parse_direction("down");
  if (azimuth >= 1.0) return parse_direction(fmt::format("{}", azimuth));
  const std::size_t line = text.find("<scnl>", first);
  if (line >= end) return {};
  const std::string_view words = text.line(line);
  const std::size_t begin = std::min(words.find('.'), words.size() - 1) + 1;
  return channel_code_direction(words.substr(begin, words.find('.', begin) - begin));
}

// The words between `Chan 1:` and the next parenthesis.
std::string section_label(const MotionText& text, std::size_t first, std::size_t end) {
  const std::size_t line = text.find("sta cha", first);
  if (line >= end) return {};
  std::string_view words = text.line(line);
  words = words.substr(lower(words).find("cha"));
  return squeeze(words.substr(0, words.find('(')));
}

bool matches_cosmos(const MotionText& text) {
  return lower(text.line(0)).find("(format v") != std::string::npos &&
         text.find("integer-header values follow") < text.size();
}

// The line after the end mark, `End-of-data for …` or `/&  ---  End of data for channel 1`, which may be missing.
std::size_t section_end(const MotionText& text, std::size_t from, std::vector<std::string>* notes) {
  for (std::size_t k = from; k < text.size(); ++k) {
    const std::string line = lower(text.line(k));
    const bool end =
        line.find("end-of-data") != std::string::npos || line.find("end of data") != std::string::npos;
    if (!end && line.find("(format v") == std::string::npos) continue;
    if (!end && notes != nullptr) notes->push_back("the line `End-of-data` is missing");
    std::size_t next = end ? k + 1 : k;
    while (next < text.size() && trim(text.line(next)).empty()) ++next;
    return next;
  }
  if (notes != nullptr)
    notes->push_back("the line `End-of-data` is missing; the file may have been cut short");
  return text.size();
}

// Adds the section at line `first`, if it is one of acceleration. Returns the line after it.
std::size_t read_section(const MotionText& text, std::size_t first,
                         std::vector<MotionComponent>& components) {
  const std::size_t integer_line = require(text, {"integer-header values follow"}, first);
  const Announcement integer_size = read_announcement(text, integer_line);
  std::size_t next = 0;
  const auto integers =
      text.numbers(integer_line + 1, integer_size.count, integer_size.width, "integers of the header", &next);
  const std::size_t real_line = require(text, {"real-header values follow"}, integer_line);
  if (real_line != next) text.fail(next, "a line `Real-header values follow`");
  const Announcement real_size = read_announcement(text, real_line);
  const auto reals =
      text.numbers(real_line + 1, real_size.count, real_size.width, "reals of the header", &next);
  const std::size_t line = require(text, {"pts, approx", "pts approx"}, next);
  if (lower(text.line(next)).find("comment") == std::string::npos && line != next)
    text.fail(next, "a line `Comment line(s) follow`");
  if (lower(text.line(line)).find("accel") == std::string::npos) return section_end(text, line, nullptr);
  const bool uncorrected = lower(text.line(first)).find("uncorrected") != std::string::npos;
  MotionComponent component = make_component(text, uncorrected ? "COSMOS V1" : "COSMOS V2");
  component.dt = time_step(text, real_line, reals);
  component.event = squeeze(text.line(first + event_line));
  const std::string_view station = text.line(first + station_line);
  const std::size_t code = station.find("Code:");
  component.station = squeeze(code == std::string_view::npos ? station : station.substr(code + 5));
  component.label = section_label(text, first + station_line + 1, integer_line);
  const AccelerationUnit unit = section_unit(text, line, integers);
  const Announcement size = read_announcement(text, line);
  set_samples(component, text.numbers(line + 1, size.count, size.width, "samples", &next), unit,
              section_direction(text, first, line, integers));
  if (reals.size() > real_peak && reals[real_peak] != unknown)
    compare_peak(component, reals[real_peak] * unit.in_si);
  while (next < text.size() && trim(text.line(next)).empty()) ++next;
  if (next < text.size() && !ends_section(text, next))
    text.fail(next, fmt::format("the line `End-of-data` after {} samples", size.count));
  next = section_end(text, next, &component.notes);
  components.push_back(std::move(component));
  return next;
}

std::vector<MotionComponent> read_cosmos(const MotionText& text, const MotionReading& /*reading*/) {
  std::vector<MotionComponent> components;
  for (std::size_t first = 0; first < text.size();) first = read_section(text, first, components);
  if (components.empty()) text.fail(0, "a file with a section of acceleration");
  return components;
}

}  // namespace

const MotionFormat cosmos_format{"COSMOS V1 or V2", matches_cosmos, read_cosmos};

}  // namespace keyblock::loading
