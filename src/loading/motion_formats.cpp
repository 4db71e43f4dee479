#include "loading/motion_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace keyblock::loading {

MotionComponent make_component(const MotionText& text, const char* format) {
  MotionComponent component;
  component.file = text.file();
  component.format = format;
  return component;
}

void set_samples(MotionComponent& component, std::vector<double> samples, const AccelerationUnit& unit,
                 const MotionDirection& direction) {
  component.azimuth = direction.azimuth;
  component.vertical = direction.vertical;
  if (direction.downwards)
    component.notes.push_back("recorded positive downwards; turned to positive upwards");
  const double factor = direction.downwards ? -unit.in_si : unit.in_si;
  for (double& a : samples) a *= factor;
  component.acceleration = std::move(samples);
  component.file_unit = unit.name;
  component.file_unit_in_si = unit.in_si;
}

std::optional<AccelerationUnit> stated_unit(const MotionText& text, const MotionReading& reading) {
  if (reading.unit.empty()) return {};
  const auto unit = acceleration_unit(reading.unit);
  if (!unit)
    text.refuse(fmt::format("unit = \"{}\"", reading.unit),
                fmt::format("a unit of acceleration: {}", acceleration_units_text));
  return unit;
}

void refuse_without_unit(const MotionText& text, std::size_t line) {
  text.fail(
      line, 1, fmt::format("no unit of the samples in {}", quoted_text(text.line(line))),
      fmt::format("the unit in the header, as in 'time (s), acceleration (m/s2)', or the key unit: {}",
                  acceleration_units_text),
      "write unit = \"m/s2\" beside file = …, or unit = \"g\", \"cm/s2\" …; keyblock motion takes --unit");
}

void compare_peak(MotionComponent& component, double stated, double rounding) {
  constexpr double tolerance = 0.01;
  const double unit = component.file_unit_in_si;
  const double read = component.acceleration[component.peak_index()];
  if (!std::isfinite(stated) || stated == 0.0) return;
  if (std::abs(std::abs(read) - std::abs(stated)) <= tolerance * std::abs(stated) + rounding) return;
  component.notes.push_back(fmt::format("the header states a peak of {:.6g} {}, the samples reach {:.6g}",
                                        stated / unit, component.file_unit, read / unit));
}

std::size_t HeaderKeys::line(std::string_view key) const {
  constexpr std::size_t longest_header = 100;
  const std::string wanted = lower(key);
  const std::size_t end = std::min(longest_header, text_.size());
  for (std::size_t k = 0; k < end; ++k) {
    if (lower(trim(text_.line(k)).substr(0, wanted.size())) == wanted) return k;
  }
  return text_.size();
}

std::string_view HeaderKeys::value(std::string_view key) const {
  std::string_view rest = trim(text_.line(line(key)));
  if (rest.empty()) return {};
  rest = trim(rest.substr(key.size()));
  if (rest.starts_with(':')) rest = trim(rest.substr(1));
  return rest;
}

std::size_t HeaderKeys::required(std::string_view key, const std::string& what) const {
  const std::size_t at = line(key);
  if (at == text_.size())
    text_.fail(0, 0, "a header without it", fmt::format("a line `{}` with {}", key, what));
  return at;
}

double HeaderKeys::number(std::string_view key, const std::string& what) const {
  const std::size_t at = required(key, what);
  const std::string_view words = value(key);
  const std::size_t end = words.find_first_not_of("0123456789+-.eEdD");
  const auto number = parse_number(words.substr(0, end));
  if (!number)
    text_.fail(at, text_.line(at).size() - words.size() + 1, quoted_text(words),
               fmt::format("{}, a number", what));
  return *number;
}

std::size_t HeaderKeys::count(std::string_view key) const {
  const double stated = number(key, "the number of samples");
  const auto points = text_.count(stated);
  if (!points)
    text_.fail(line(key), 1, fmt::format("{:.15g}", stated),
               "the number of samples, which the file must hold");
  return *points;
}

double HeaderKeys::time_step(std::string_view key) const {
  const double step = number(key, time_step_text);
  if (!is_time_step(step)) text_.fail(line(key), 1, fmt::format("{:.15g}", step), time_step_text);
  return step;
}

}  // namespace keyblock::loading
