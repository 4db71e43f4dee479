#include <fmt/format.h>

#include <cmath>

#include "loading/motion_file.h"
#include "loading/motion_text.h"

// "Volume 2" files of the California Strong Motion Instrumentation Program (CDMG/CSMIP Report OSMS 85-03):
// per channel 25 lines of text, a header of integers and reals, and the blocks
//   3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)
// of acceleration, velocity and displacement.
namespace keyblock::loading {
namespace {

constexpr const char* block_title = "points of accel data equally spaced at";
constexpr std::size_t header_station_line =
    6;  // of a channel's text, as the event in the two lines before the channel

// The word after "units:" or "in" up to the closing parenthesis.
AccelerationUnit block_unit(const MotionText& text, std::size_t line) {
  const std::string title = lower(text.line(line));
  const std::size_t at = title.find("units");
  if (at != std::string::npos) {
    std::string word = title.substr(at + 5);
    const std::size_t begin = word.find_first_not_of(" :=");
    if (begin != std::string::npos) word = word.substr(begin, word.find_first_of("),", begin) - begin);
    if (const auto unit = acceleration_unit(word)) return *unit;
  }
  text.fail(line, "a unit of acceleration, as in `(UNITS: CM/SEC/SEC)`");
}

// "CHAN  1:  90 DEG" anywhere in the channel's text.
MotionDirection find_direction(const MotionText& text, std::size_t first, std::size_t end,
                               std::string& label) {
  for (std::size_t k = first; k < end; ++k) {
    const std::string lower_line = lower(text.line(k));
    const std::string_view line = lower_line;
    const std::size_t chan = line.find("chan");
    const std::size_t colon = chan == std::string::npos ? chan : line.find(':', chan);
    if (colon == std::string::npos) continue;
    const std::string words = squeeze(text.line(k).substr(colon + 1));
    const std::string direction = words.substr(0, lower(words).find(" from"));
    label = fmt::format("channel {}: {}", trim(line.substr(chan + 4, colon - chan - 4)), direction);
    return parse_direction(direction);
  }
  return {};
}

void check_peak(const MotionText& text, std::size_t first, std::size_t end, MotionComponent& component) {
  const std::size_t line = text.find("peak acceleration", first);
  if (line >= end) return;
  const auto stated = number_after(text.line(line), "peak acceleration");
  const double read = component.acceleration[component.peak_index()] / component.file_unit_in_si;
  if (stated && std::abs(std::abs(read) - std::abs(*stated)) > 0.01 * std::abs(*stated)) {
    component.notes.push_back(
        fmt::format("the header states a peak of {}, the samples reach {}", *stated, read));
  }
}

}  // namespace

bool matches_csmip(const MotionText& text) {
  return text.find(block_title) < text.size();
}

std::vector<MotionComponent> read_csmip(const MotionText& text) {
  std::vector<MotionComponent> components;
  std::size_t first = 0;  // line of the channel's text
  for (std::size_t line = text.find(block_title); line < text.size();
       line = text.find(block_title, line + 1)) {
    MotionComponent component;
    component.file = text.file();
    component.format = "CSMIP V2";
    const std::string title = squeeze(text.line(line));
    const auto points = text.count(parse_number(std::string_view(title).substr(0, title.find(' '))));
    const auto dt = number_after(title, "equally spaced at");
    if (!points) {
      text.fail(line, "the number of points, which the file must hold, before `POINTS OF ACCEL DATA`");
    }
    if (!is_time_step(dt)) text.fail(line, fmt::format("{}, after `EQUALLY SPACED AT`", time_step_text));
    component.dt = *dt;
    component.event = squeeze(text.line(first + 2));
    component.station = squeeze(text.line(first + header_station_line));
    const MotionDirection direction = find_direction(text, first, line, component.label);
    std::size_t next = 0;
    set_samples(component, text.numbers(line + 1, *points, 0, "samples", &next), block_unit(text, line),
                direction);
    check_peak(text, first, line, component);
    components.push_back(std::move(component));
    const std::size_t end = text.find("end of data for channel", next);
    if (end == text.size()) {
      text.fail(text.size() - 1, 0, "the end of the file",
                fmt::format("the line `END OF DATA FOR CHANNEL` of channel {}", components.size()),
                "the file may have been cut short");
    }
    first = end + 1;
    line = end;
  }
  return components;
}

}  // namespace keyblock::loading
