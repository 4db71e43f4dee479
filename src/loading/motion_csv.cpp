#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "loading/motion_file.h"
#include "loading/motion_text.h"

namespace keyblock::loading {
namespace {

// Steps that differ by less than this share of their mean count as equal: times are often rounded to few
// digits.
constexpr double even_spacing_tolerance = 1e-3;

bool is_comment(std::string_view line) {
  return trim(line).empty() || trim(line).front() == '#';
}

std::vector<std::string_view> columns(std::string_view line) {
  const char* separator = line.find(';') != std::string_view::npos   ? ";"
                          : line.find(',') != std::string_view::npos ? ","
                                                                     : " \t";
  const bool blanks = *separator == ' ';
  std::vector<std::string_view> fields;
  line = trim(line);
  for (;;) {
    const std::size_t end = line.find_first_of(separator);
    fields.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
    if (blanks) line = trim(line);
  }
}

bool is_row(std::string_view line) {
  const auto fields = columns(line);
  return fields.size() == 2 && parse_number(fields[0]) && parse_number(fields[1]);
}

// The unit in a header line such as `time (s), acceleration [cm/s2]` or `t,a_g`.
std::optional<AccelerationUnit> header_unit(std::string_view header) {
  const auto fields = columns(header);
  std::string word(fields.size() >= 2 ? fields.back() : header);
  if (const auto unit = acceleration_unit(word)) return unit;
  std::erase_if(word, [](char c) { return c == ')' || c == ']' || c == '"'; });
  const std::size_t at = word.find_last_of("([ _:");
  return at == std::string::npos ? std::nullopt : acceleration_unit(std::string_view(word).substr(at + 1));
}

void set_times(MotionComponent& component, std::vector<double> times) {
  component.start = times.front();
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  double worst = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    worst = std::max(worst, std::abs(times[k] - (times.front() + mean * static_cast<double>(k))));
  }
  if (worst <= even_spacing_tolerance * mean) {
    component.dt = mean;
  } else {
    component.notes.push_back("samples are not evenly spaced in time");
    component.times = std::move(times);
  }
}

}  // namespace

bool matches_csv(const MotionText& text) {
  std::size_t header_lines = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (is_comment(text.line(k))) continue;
    if (is_row(text.line(k))) return true;
    if (++header_lines > 1) return false;
  }
  return false;
}

std::vector<MotionComponent> read_csv(const MotionText& text) {
  MotionComponent component;
  component.file = text.file();
  component.format = "CSV";
  std::optional<AccelerationUnit> unit;
  std::vector<double> times, values;
  bool header_possible = true;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::string_view line = text.line(k);
    if (is_comment(line)) continue;
    if (!is_row(line)) {
      if (!header_possible) text.fail(k, "two finite numbers: time in seconds and acceleration");
      unit = header_unit(line);
      if (!unit && line.find_first_of("([") != std::string_view::npos) {
        text.fail(k, "a unit of acceleration in the header: m/s2, cm/s2 or g");
      }
      header_possible = false;
      continue;
    }
    header_possible = false;
    const auto fields = columns(line);
    const double time = *parse_number(fields[0]);
    if (!times.empty() && !(time > times.back())) {
      text.fail(k, 1, fmt::format("time {}", time), fmt::format("a time after {}", times.back()));
    }
    times.push_back(time);
    values.push_back(*parse_number(fields[1]));
  }
  if (times.size() < 2) text.fail(text.size() - 1, "at least two rows of time and acceleration");
  if (!unit) {
    unit = AccelerationUnit{"m/s2", 1.0};
    component.notes.push_back("the file names no unit; m/s2 is assumed");
  }
  set_times(component, std::move(times));
  set_samples(component, std::move(values), *unit, {});
  return {std::move(component)};
}

}  // namespace keyblock::loading
