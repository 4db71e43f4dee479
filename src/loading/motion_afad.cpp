#include <fmt/format.h>

#include <array>

#include "loading/motion_formats.h"

// Records of AFAD, Turkey, as its older site gives them: a header of lines `KEY : value`, a line with the directions, and then samples
// of three components, side by side.
//   STRONG GROUND MOTION RECORDS OF TURKIYE
//   RAW PGA VALUES (gal)    : (N-S) 1.218825 (E-W) 1.207812 (U-D) 0.645862
//          N-S          E-W          U-D
namespace keyblock::loading {
namespace {

constexpr std::size_t afad_components = 3;
constexpr std::string_view afad_title = "strong ground motion records of turk";

bool matches_afad(const MotionText& text) {
  return lower(text.line(0)).find(afad_title) != std::string::npos;
}

std::vector<std::string> words_of_line(std::string_view line) {
  std::vector<std::string> words;
  const std::string all = squeeze(line);
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find(' ', begin), all.size());
    words.push_back(all.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

// The line of three directions that ends the header.
std::size_t direction_line(const MotionText& text, const HeaderKeys& keys) {
  constexpr std::size_t longest_header = 40;
  for (std::size_t k = 1; k < longest_header && k < text.size(); ++k) {
    const auto words = words_of_line(text.line(k));
    if (words.size() != afad_components) continue;
    bool all = true;
    for (const std::string& word : words)
      all = all && parse_direction(word).stated() && !parse_number(word).has_value();
    if (all) return k;
  }
  text.fail(keys.line("NUMBER OF DATA"), "a line with three directions, `N-S  E-W  U-D`, before the samples");
}

// Peaks of the header, in the order of the columns.
std::optional<double> stated_peak(const HeaderKeys& keys, const std::string& direction) {
  const std::string_view value = keys.value("RAW PGA VALUES");
  const std::size_t at = value.find("(" + direction + ")");
  return at == std::string_view::npos ? std::nullopt : number_after(value.substr(at), "(" + direction + ")");
}

std::vector<MotionComponent> read_afad(const MotionText& text, const MotionReading& /*reading*/) {
  const HeaderKeys keys(text);
  const std::size_t points = keys.count("NUMBER OF DATA");
  const double dt = keys.time_step("SAMPLING INTERVAL (sec)");
  const std::size_t peak_line = keys.required("RAW PGA VALUES", "the unit of the samples");
  const auto unit = line_unit(text, peak_line);
  if (!unit) text.fail(peak_line, "the unit of the samples, as in `RAW PGA VALUES (gal)`");
  const std::size_t line = direction_line(text, keys);
  const auto names = words_of_line(text.line(line));
  std::size_t next = 0;
  const auto all = text.numbers(line + 1, afad_components * points, 0, "values in three columns", &next);
  if (next != line + 1 + points) text.fail(next - 1, fmt::format("three values in each of {} lines", points));
  if (next < text.size())
    text.fail(next, fmt::format("the end of the file after {} lines of samples", points));
  std::vector<MotionComponent> components;
  for (std::size_t c = 0; c < afad_components; ++c) {
    MotionComponent component = make_component(text, afad_format.name);
    component.event =
        fmt::format("{}, M {}", keys.value("EARTHQUAKE DATE"), keys.value("EARTHQUAKE MAGNITUDE"));
    component.station = fmt::format("{} {}", keys.value("STATION ID"), keys.value("PLACE"));
    component.label = names[c];
    component.dt = dt;
    std::vector<double> samples(points);
    for (std::size_t k = 0; k < points; ++k) samples[k] = all[afad_components * k + c];
    set_samples(component, std::move(samples), *unit, parse_direction(names[c]));
    if (const auto peak = stated_peak(keys, names[c])) compare_peak(component, *peak * unit->in_si);
    components.push_back(std::move(component));
  }
  return components;
}

}  // namespace

const MotionFormat afad_format{"AFAD", matches_afad, read_afad};

}  // namespace keyblock::loading
