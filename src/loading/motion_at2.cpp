#include <fmt/format.h>

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

// "ACCELERATION TIME SERIES IN UNITS OF G", "The units are (g)".
void find_unit(const MotionText& text, std::size_t header_end, MotionComponent& component,
               AccelerationUnit& unit) {
  unit = {"g", standard_gravity};
  for (std::size_t k = 0; k < header_end; ++k) {
    const std::string line = lower(text.line(k));
    const std::size_t at = line.find("unit");
    if (at == std::string::npos) continue;
    if (line.find("veloc") != std::string::npos || line.find("displ") != std::string::npos) {
      text.fail(k, "a time series of acceleration");
    }
    std::string word = line.substr(line.find_last_of(" (:=") + 1);
    std::erase(word, ')');
    if (const auto named = acceleration_unit(word)) {
      unit = *named;
      return;
    }
    text.fail(k, "a unit of acceleration: g, cm/s2 or m/s2");
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
  if (!size.points || !(*size.points >= 1.0))
    text.fail(header, "the number of samples, as in `NPTS= 3930, DT= .005 SEC`");
  if (!size.dt || !(*size.dt > 0.0))
    text.fail(header, "the time step in seconds, as in `NPTS= 3930, DT= .005 SEC`");
  MotionComponent component;
  component.file = text.file();
  component.format = "PEER AT2";
  component.dt = *size.dt;
  // Classical header: title / event, station, direction / unit / size.
  const std::string title = squeeze(text.line(header >= 3 ? 1 : 0));
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
  find_unit(text, header, component, unit);
  std::size_t next = 0;
  set_samples(component,
              text.numbers(header + 1, static_cast<std::size_t>(*size.points), 0, "samples", &next), unit,
              parse_direction(component.label));
  if (next < text.size()) text.fail(next, fmt::format("the end of the file after {} samples", *size.points));
  return {std::move(component)};
}

}  // namespace keyblock::loading
