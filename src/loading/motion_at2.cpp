#include <fmt/format.h>

#include "loading/motion_formats.h"

// Records of the Pacific Earthquake Engineering Research Center: lines of text, one of which is
//   NPTS=  3930, DT= .00500 SEC     or, in older files,     3930   .00500    NPTS, DT
// and samples after it. The unit stands in a line of its own: `ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: …`.
namespace keyblock::loading {
namespace {

constexpr std::size_t longest_at2_header = 20;

std::size_t size_line(const MotionText& text) {
  for (std::size_t k = 0; k < longest_at2_header && k < text.size(); ++k) {
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

// Whether a line of text can be the one with the unit.
bool is_about_samples(std::string_view line) {
  const std::string words = lower(line);
  for (const char* word : {"accel", "veloc", "displ", "unit", "time hist", "time series", "amplitude"}) {
    if (words.find(word) != std::string::npos) return true;
  }
  return false;
}

// A unit stands in a line about samples, or it is one that can be nothing else.
bool may_name_unit(const MotionText& text, std::size_t line) {
  if (is_about_samples(text.line(line))) return true;
  for (const UnitMention& mention : unit_mentions(text.line(line))) {
    if (mention.sure && mention.kind == UnitKind::acceleration) return true;
  }
  return false;
}

AccelerationUnit find_unit(const MotionText& text, std::size_t title, std::size_t size_at,
                           const MotionReading& reading, MotionComponent& component) {
  std::optional<AccelerationUnit> unit;
  for (std::size_t k = 0; k <= size_at; ++k) {
    if (k == title || !may_name_unit(text, k)) continue;
    refuse_other_quantity(text, k);
    const auto named = line_unit(text, k);
    if (named && unit && named->in_si != unit->in_si)
      text.fail(k, fmt::format("one unit, and not {} and {}", unit->name, named->name));
    if (named) unit = named;
  }
  if (!unit) unit = stated_unit(text, reading);
  if (unit) return *unit;
  component.notes.push_back("the file names no unit; g, as in all AT2 files, is assumed");
  return {"g", standard_gravity};
}

// Classical header: title / event, station, direction / unit / size. Returns the line of event, station and direction, or that of the
// size when the header is another.
std::size_t read_title(const MotionText& text, std::size_t size_at, MotionComponent& component) {
  const std::size_t title_line = size_at >= 3 ? 1 : 0;
  const std::string title = squeeze(text.line(title_line));
  const std::size_t last = title.rfind(',');
  const std::size_t first = title.find(',');
  const std::string head = lower(text.line(0));
  const bool classical = head.find("peer") != std::string::npos || head.find("pacific") != std::string::npos;
  if (classical && last != std::string::npos && first != last) {
    component.label = squeeze(std::string_view(title).substr(last + 1));
    component.event = title.substr(0, first);
    component.station = squeeze(std::string_view(title).substr(first + 1, last - first - 1));
  } else {
    component.event = squeeze(text.line(0));
  }
  return classical ? title_line : text.size();
}

// Without signs and words such as `COMP`.
std::string plain_label(std::string_view label) {
  std::string words = lower(label.substr(0, label.find('(')));
  for (const std::string_view sign : {"°", "=", ":", "_"}) {
    for (std::size_t at = words.find(sign); at != std::string::npos; at = words.find(sign, at))
      words.replace(at, sign.size(), " ");
  }
  words = squeeze(words);
  for (const std::string_view word : {"component", "comp.", "comp", "direction", "dir.", "dir", "azimuth",
                                      "az.", "az", "horizontal", "horiz.", "hor"}) {
    if (words.starts_with(word)) words = squeeze(std::string_view(words).substr(word.size()));
    if (words.ends_with(word)) words = squeeze(std::string_view(words).substr(0, words.size() - word.size()));
  }
  return words;
}

// Of a code of the station and the direction.
MotionDirection direction_at_end(std::string_view words) {
  for (const std::string_view end : {"-up", " up", "-ud", "-dwn", "-down", "-ver", "-vert", "-ns", "-ew",
                                     "-n", "-e", "up", "dwn", "ver"}) {
    if (words.ends_with(end)) return parse_direction(trim(end.starts_with('-') ? end.substr(1) : end));
  }
  constexpr std::size_t digits = 3;
  if (words.size() <= digits) return {};
  const std::string_view last = words.substr(words.size() - digits);
  const char before = words[words.size() - digits - 1];
  const bool in_code =
      std::string_view("- 0123456789abcdefghijklmnopqrstuvwxyz").find(before) != std::string_view::npos;
  const bool is_number = last.find_first_not_of("0123456789") == std::string_view::npos;
  return in_code && is_number ? parse_direction(last) : MotionDirection{};
}

// What stands behind the last comma of the title: `090`, `COMP 090`, `S16E`, `UP`, `L-N-S`, `H-E05140`, `A-HMC180`, `ELC-UP`.
MotionDirection at2_direction(std::string_view label) {
  const std::string words = plain_label(label);
  if (const auto whole = parse_direction(words); whole.stated()) return whole;
  if (const auto code = channel_code_direction(words); code.stated()) return code;
  return direction_at_end(words);
}

bool matches_at2(const MotionText& text) {
  return size_line(text) < text.size();
}

std::vector<MotionComponent> read_at2(const MotionText& text, const MotionReading& reading) {
  const std::size_t header = size_line(text);
  const Size size = read_size(text.line(header));
  const auto points = text.count(size.points);
  if (!points)
    text.fail(header, "the number of samples, which the file must hold, as in `NPTS= 3930, DT= .005 SEC`");
  if (!is_time_step(size.dt))
    text.fail(header, fmt::format("{}, as in `NPTS= 3930, DT= .005 SEC`", time_step_text));
  MotionComponent component = make_component(text, at2_format.name);
  component.dt = *size.dt;
  const std::size_t title = read_title(text, header, component);
  const AccelerationUnit unit = find_unit(text, title, header, reading, component);
  std::size_t next = 0;
  set_samples(component, text.numbers(header + 1, *points, 0, "samples", &next), unit,
              at2_direction(component.label));
  if (next < text.size()) text.fail(next, fmt::format("the end of the file after {} samples", *points));
  return {std::move(component)};
}

}  // namespace

const MotionFormat at2_format{"PEER AT2", matches_at2, read_at2};

}  // namespace keyblock::loading
