#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "loading/motion_file.h"
#include "loading/motion_text.h"

namespace keyblock::loading {
namespace {

// Steps that differ by less than this share of their mean count as equal: times are often rounded to few
// digits.
constexpr double even_spacing_tolerance = 1e-3;

// s. Beyond it the spacing of numbers is coarser than steps of records.
constexpr double longest_time = 1e10;

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

// Whether a line that is no row was meant as one: a first row that is damaged is no header.
bool begins_like_row(std::string_view line) {
  const std::string first = lower(columns(line).front());
  const bool number = first.find_first_not_of("0123456789+-.e") == std::string::npos &&
                      first.find_first_of("0123456789") != std::string::npos;
  return number || first == "nan" || first == "inf" || first == "-inf";
}

// The end of a header line, which may name the unit: `[cm/s2]`, `g` of `a_g`, `mm/s2` of `acc in mm/s2`.
struct HeaderEnd {
  std::string word;
  bool names_unit = false;  // by its place or its look, whether or not the unit is known
};

HeaderEnd header_end(std::string_view header) {
  const auto fields = columns(header);
  std::string field(fields.size() >= 2 ? fields.back() : header);
  std::erase(field, '"');
  if (acceleration_unit(field)) return {field, true};
  const std::size_t open = field.find_last_of("([");
  if (open != std::string::npos) {
    return {field.substr(open + 1, field.find_first_of(")]", open) - open - 1), true};
  }
  const std::string words = squeeze(field);
  const std::size_t at = words.find_last_of(" _:");
  const std::string word = at == std::string::npos ? words : words.substr(at + 1);
  const std::string before = at == std::string::npos ? "" : lower(words.substr(0, at));
  constexpr std::string_view others[] = {"mm", "cm", "m", "km", "in", "ft", "mg", "mgal", "kine"};
  const bool looks = word.find_first_of("/%") != std::string::npos ||
                     std::find(std::begin(others), std::end(others), lower(word)) != std::end(others);
  return {word, looks || before == "in" || before.ends_with(" in") || acceleration_unit(word).has_value()};
}

// The unit that a header line names, such as `time (s), acceleration [cm/s2]` or `t,a_g`; absent when it names none.
std::optional<AccelerationUnit> header_unit(const MotionText& text, std::size_t line) {
  const std::string words = lower(text.line(line));
  if (words.find("veloc") != std::string::npos || words.find("displ") != std::string::npos) {
    text.fail(line, "a time series of acceleration");
  }
  const HeaderEnd end = header_end(text.line(line));
  const auto unit = acceleration_unit(end.word);
  if (!unit && (end.names_unit || words.find_first_of("([") != std::string::npos)) {
    text.fail(line, "a unit of acceleration in the header: m/s2, cm/s2 or g");
  }
  return unit;
}

std::vector<std::string> words_of(std::string_view text, std::string_view between) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(between), text.size());
    if (end > 0) words.push_back(lower(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

// Seconds per unit; absent for any other word.
std::optional<double> time_unit(std::string_view word) {
  for (const char* second : {"s", "sec", "secs", "second", "seconds"}) {
    if (word == second) return 1.0;
    if (word == std::string("m") + second || word == std::string("milli") + second) return 1e-3;
  }
  return {};
}

// Seconds per unit of time that a header line names, such as `time (ms), acceleration [g]`, `t_s,a` or `t ms a`; 1 when it names
// none. Where blanks part the columns, all words but the last may be of the time.
double header_time_unit(const MotionText& text, std::size_t line) {
  const std::string_view header = text.line(line);
  const auto fields = columns(header);
  if (fields.size() < 2) return 1.0;
  const bool blanks = header.find_first_of(",;") == std::string_view::npos;
  const std::string_view time = blanks ? header.substr(0, header.rfind(fields.back())) : fields.front();
  const std::size_t open = time.find_first_of("([");
  const std::size_t close = time.find_first_of(")]");
  constexpr std::string_view between = " \t_:/\"()[]";
  constexpr std::string_view others[] = {"us",   "µs",      "ns", "usec", "min",
                                         "mins", "minutes", "h",  "hr",   "hours"};
  if (open < close && close != std::string_view::npos) {
    const auto unit = time_unit(lower(trim(time.substr(open + 1, close - open - 1))));
    if (!unit) text.fail(line, "a unit of time in the header: s or ms");
    return *unit;
  }
  for (const std::string& word : words_of(time, between)) {
    if (const auto unit = time_unit(word)) return *unit;
    if (std::find(std::begin(others), std::end(others), word) != std::end(others))
      text.fail(line, "a unit of time in the header: s or ms");
  }
  return 1.0;
}

// Whether a word of a comment is a unit of acceleration other than m/s2, known or not.
bool is_other_unit(std::string_view word) {
  if (const auto unit = acceleration_unit(word)) return unit->in_si != 1.0;
  std::string plain = lower(word);
  std::erase_if(plain, [](char c) { return c == '^' || c == '*'; });
  const auto ends = [&](std::string_view end) { return plain.ends_with(end); };
  return ends("/s2") || ends("/s²") || ends("/s/s") || ends("/sec2") || ends("/sec/sec") || ends("%g") ||
         plain == "mg" || plain == "mgal";
}

// Comments are not read. One that speaks of another unit than the one that is assumed must not be passed over.
void refuse_unit_in_comment(const MotionText& text) {
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (!is_comment(text.line(k))) continue;
    const auto words = words_of(text.line(k), " \t#,;:\"()[]");
    if (std::any_of(words.begin(), words.end(), is_other_unit))
      text.fail(k,
                "the unit in a header line and not in a comment, such as 'time (s), acceleration (cm/s2)'");
  }
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
    if (header_lines == 0 && begins_like_row(text.line(k)) && columns(text.line(k)).size() >= 2) return true;
    if (++header_lines > 1) return false;
  }
  return false;
}

std::vector<MotionComponent> read_csv(const MotionText& text) {
  MotionComponent component;
  component.file = text.file();
  component.format = "CSV";
  std::optional<AccelerationUnit> unit;
  double seconds = 1.0;
  std::vector<double> times, values;
  bool header_possible = true;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const std::string_view line = text.line(k);
    if (is_comment(line)) continue;
    if (!is_row(line)) {
      if (!header_possible || begins_like_row(line))
        text.fail(k, "two finite numbers: time and acceleration");
      unit = header_unit(text, k);
      seconds = header_time_unit(text, k);
      header_possible = false;
      continue;
    }
    header_possible = false;
    const auto fields = columns(line);
    const double time = *parse_number(fields[0]);
    if (!times.empty() && !(time > times.back())) {
      text.fail(k, 1, fmt::format("time {}", time), fmt::format("a time after {}", times.back()));
    }
    if (!(std::abs(time) <= longest_time)) {
      text.fail(k, 1, fmt::format("time {}", time), fmt::format("a time within ±{} s", longest_time));
    }
    times.push_back(time);
    values.push_back(*parse_number(fields[1]));
  }
  if (times.size() < 2) text.fail(text.size() - 1, "at least two rows of time and acceleration");
  for (double& time : times) time *= seconds;
  if (!is_time_step((times.back() - times.front()) / static_cast<double>(times.size() - 1))) {
    text.fail(text.size() - 1, 1, fmt::format("times from {} to {}", times.front(), times.back()),
              std::string(time_step_text) + ", on average");
  }
  if (!unit) {
    refuse_unit_in_comment(text);
    unit = AccelerationUnit{"m/s2", 1.0};
    component.notes.push_back("the file names no unit; m/s2 is assumed");
  }
  set_times(component, std::move(times));
  set_samples(component, std::move(values), *unit, {});
  return {std::move(component)};
}

}  // namespace keyblock::loading
