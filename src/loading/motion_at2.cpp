#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "loading/motion_file.h"
#include "loading/motion_text.h"

// Records of the Pacific Earthquake Engineering Research Center: lines of text, one of which is
//   NPTS=  3930, DT= .00500 SEC     or, in older files,     3930   .00500    NPTS, DT
// and samples after it.
namespace keyblock::loading {
namespace {

constexpr std::size_t longest_header = 20;

std::size_t size_line(const MotionText& text) {
  for (std::size_t k = 0; k < longest_header && k < text.size(); ++k) {
    const std::string line = lower(text.line(k));
    if (line.find("npts") != std::string::npos && line.find("dt") != std::string::npos) return k;
  }
  return text.size();
}

struct Size {
  std::optional<double> points, dt;
};

Size read_size(std::string_view line) {
  Size size{number_after(line, "npts"), number_after(line, "dt")};
  if (size.points && size.dt) return size;
  const std::string numbers = squeeze(line.substr(0, lower(line).find("npts")));
  const std::size_t gap = numbers.find(' ');
  if (gap == std::string::npos) return size;
  return {parse_number(std::string_view(numbers).substr(0, gap)),
          parse_number(std::string_view(numbers).substr(gap + 1))};
}

// The words after "units of", "units are", "unit:" and the like, or npos where a line names no unit. "COMMUNITY HOSPITAL"
// does not.
std::size_t unit_words(std::string_view line) {
  for (std::size_t at = line.find("unit"); at != std::string::npos; at = line.find("unit", at + 1)) {
    if (at > 0 && std::isalpha(static_cast<unsigned char>(line[at - 1])) != 0) continue;
    const std::size_t end = at + (line.substr(at).starts_with("units") ? 5 : 4);
    const std::size_t next = std::min(line.find_first_not_of(' ', end), line.size());
    for (const std::string_view word : {"of ", "are ", "is ", ":", "=", "("}) {
      if (line.substr(next).starts_with(word)) return next + word.size();
    }
  }
  return std::string::npos;
}

// The unit is the first word after "units of", or the last of the line: "in units of g", "the units are (g)".
std::optional<AccelerationUnit> unit_of(std::string_view line, std::size_t words) {
  const std::size_t begin = std::min(line.find_first_not_of(" :=(", words), line.size());
  const std::string_view first = line.substr(begin, line.find_first_of(" ),;", begin) - begin);
  if (const auto unit = acceleration_unit(first)) return unit;
  std::string last(line.substr(line.find_last_of(" (:=") + 1));
  std::erase(last, ')');
  return acceleration_unit(last);
}

void find_unit(const MotionText& text, std::size_t title, std::size_t header_end, MotionComponent& component,
               AccelerationUnit& unit) {
  unit = {"g", standard_gravity};
  for (std::size_t k = 0; k < header_end; ++k) {
    const std::string line = lower(text.line(k));
    const std::size_t words = k == title ? std::string::npos : unit_words(line);
    if (words == std::string::npos) continue;
    if (line.find("veloc") != std::string::npos || line.find("displ") != std::string::npos) {
      text.fail(k, "a time series of acceleration");
    }
    const auto named = unit_of(line, words);
    if (!named) text.fail(k, "a unit of acceleration: g, cm/s2 or m/s2");
    unit = *named;
    return;
  }
  component.notes.push_back("the file names no unit; g, as in all AT2 files, is assumed");
}

}  // namespace

bool matches_at2(const MotionText& text) {
  return size_line(text) < text.size();
}

std::vector<MotionComponent> read_at2(const MotionText& text) {
  const std::size_t header = size_line(text);
  const Size size = read_size(text.line(header));
  const auto points = text.count(size.points);
  if (!points)
    text.fail(header, "the number of samples, which the file must hold, as in `NPTS= 3930, DT= .005 SEC`");
  if (!is_time_step(size.dt))
    text.fail(header, fmt::format("{}, as in `NPTS= 3930, DT= .005 SEC`", time_step_text));
  MotionComponent component;
  component.file = text.file();
  component.format = "PEER AT2";
  component.dt = *size.dt;
  // Classical header: title / event, station, direction / unit / size.
  const std::size_t title_line = header >= 3 ? 1 : 0;
  const std::string title = squeeze(text.line(title_line));
  const std::size_t last = title.rfind(',');
  const std::size_t first = title.find(',');
  const bool classical = lower(text.line(0)).find("peer") != std::string::npos ||
                         lower(text.line(0)).find("pacific") != std::string::npos;
  if (classical && last != std::string::npos && first != last) {
    component.label = squeeze(std::string_view(title).substr(last + 1));
    component.event = title.substr(0, first);
    component.station = squeeze(std::string_view(title).substr(first + 1, last - first - 1));
  } else {
    component.event = squeeze(text.line(0));
  }
  AccelerationUnit unit;
  find_unit(text, classical ? title_line : header, header, component, unit);
  std::size_t next = 0;
  set_samples(component, text.numbers(header + 1, *points, 0, "samples", &next), unit,
              parse_direction(component.label));
  if (next < text.size()) text.fail(next, fmt::format("the end of the file after {} samples", *points));
  return {std::move(component)};
}

}  // namespace keyblock::loading
