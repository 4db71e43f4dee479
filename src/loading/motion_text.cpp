#include "loading/motion_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "loading/motion_file.h"

namespace keyblock::loading {
namespace {

bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t longest = 40;
  text = trim(text);
  return text.empty() ? std::string("a blank field") : '"' + printable(text, longest) + '"';
}

// Where the number that starts at `begin` ends, for fields without a fixed width.
std::size_t free_field_end(std::string_view line, std::size_t begin) {
  std::size_t end = begin + 1;
  for (; end < line.size(); ++end) {
    const char c = line[end];
    if (is_blank(c) || c == ',' || c == ';') break;
    const char before = line[end - 1];
    const bool in_exponent = before == 'e' || before == 'E' || before == 'd' || before == 'D';
    if ((c == '-' || c == '+') && !in_exponent) break;
  }
  return end;
}

}  // namespace

MotionText::MotionText(std::string file, std::string content)
    : file_(std::move(file)), content_(std::move(content)) {
  std::string_view all = content_;
  if (all.starts_with("\xEF\xBB\xBF")) all.remove_prefix(3);
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    std::string_view text = all.substr(begin, end - begin);
    while (!text.empty() && (is_blank(text.back()) || text.back() == '\x1a')) text.remove_suffix(1);
    lines_.push_back(text);
    begin = end + 1;
  }
  while (!lines_.empty() && lines_.back().empty()) lines_.pop_back();
}

std::string_view MotionText::line(std::size_t k) const {
  return k < lines_.size() ? lines_[k] : std::string_view{};
}

std::size_t MotionText::find(std::string_view text, std::size_t from) const {
  const std::string wanted = lower(text);
  for (std::size_t k = from; k < lines_.size(); ++k) {
    if (lower(lines_[k]).find(wanted) != std::string::npos) return k;
  }
  return lines_.size();
}

std::vector<double> MotionText::numbers(std::size_t first, std::size_t count, std::size_t width,
                                        const std::string& what, std::size_t* next_line) const {
  std::vector<double> values;
  values.reserve(std::min(count, content_.size()));
  std::size_t k = first;
  for (; values.size() < count; ++k) {
    if (k >= lines_.size()) {
      fail(lines_.empty() ? 0 : lines_.size() - 1, 0,
           fmt::format("the end of the file after {} {}", values.size(), what),
           fmt::format("{} {}", count, what), "the file may have been cut short");
    }
    const std::string_view row = lines_[k];
    for (std::size_t begin = 0; begin < row.size();) {
      std::size_t end = begin + width;
      if (width == 0) {
        while (begin < row.size() && (is_blank(row[begin]) || row[begin] == ',')) ++begin;
        if (begin == row.size()) break;
        end = free_field_end(row, begin);
      }
      const std::string_view field = row.substr(begin, end - begin);
      if (values.size() == count) {
        fail(k, begin + 1, quoted(field), fmt::format("the end of the line after {} {}", count, what));
      }
      const auto value = parse_number(field);
      if (!value) {
        fail(k, begin + 1, quoted(field),
             fmt::format("a finite number ({} of {} {} read so far)", values.size(), count, what));
      }
      values.push_back(*value);
      begin = end;
    }
  }
  if (next_line != nullptr) *next_line = k;
  return values;
}

std::optional<std::size_t> MotionText::count(std::optional<double> stated, std::size_t least) const {
  const bool fits = stated && *stated >= static_cast<double>(least) &&
                    *stated <= static_cast<double>(content_.size()) && *stated == std::floor(*stated);
  return fits ? std::optional(static_cast<std::size_t>(*stated)) : std::nullopt;
}

void MotionText::fail(std::size_t line, std::size_t column, std::string found, std::string expected,
                      std::string hint) const {
  Diagnostic diagnostic;
  diagnostic.where = {file_, static_cast<int>(line) + 1, static_cast<int>(column)};
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

void MotionText::fail(std::size_t line, std::string expected) const {
  const std::string found = line < lines_.size() ? quoted(lines_[line]) : "the end of the file";
  fail(line < lines_.size() ? line : lines_.size(), 1, found, std::move(expected));
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string squeeze(std::string_view text) {
  std::string out;
  for (const char c : trim(text)) {
    if (!is_blank(c))
      out += c;
    else if (out.back() != ' ')
      out += ' ';
  }
  return out;
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

std::optional<double> parse_number(std::string_view text) {
  text = trim(text);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  std::string digits(text);
  std::replace_if(
      digits.begin(), digits.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  double value = 0.0;
  const char* end = digits.data() + digits.size();
  const auto result = std::from_chars(digits.data(), end, value);
  if (digits.empty() || result.ec != std::errc{} || result.ptr != end || !std::isfinite(value)) return {};
  return value;
}

std::optional<double> number_after(std::string_view text, std::string_view key) {
  const std::size_t at = lower(text).find(lower(key));
  if (at == std::string::npos) return {};
  std::string_view rest = text.substr(at + key.size());
  const std::size_t begin = rest.find_first_not_of(" \t=:(");
  if (begin == std::string_view::npos) return {};
  rest.remove_prefix(begin);
  const std::size_t end = rest.find_first_not_of("0123456789+-.eEdD");
  std::string_view number = rest.substr(0, end);
  while (!number.empty() && number.back() == '.' && number.find('.') + 1 != number.size())
    number.remove_suffix(1);
  return parse_number(number);
}

bool is_time_step(std::optional<double> seconds) {
  constexpr double shortest = 1e-9, longest = 1e6;
  return seconds && *seconds >= shortest && *seconds <= longest;
}

std::optional<AccelerationUnit> acceleration_unit(std::string_view word) {
  std::string unit = lower(word);
  std::erase_if(unit, [](char c) { return is_blank(c) || c == '^' || c == '*'; });
  const std::pair<const char*, AccelerationUnit> known[] = {
      {"g", {"g", standard_gravity}}, {"cm/s2", {"cm/s2", 0.01}}, {"m/s2", {"m/s2", 1.0}}};
  if (unit == "gal" || unit == "gals" || unit == "cm/s/s" || unit == "cm/sec/sec" || unit == "cm/sec2" ||
      unit == "cm/s²") {
    unit = "cm/s2";
  } else if (unit == "m/s/s" || unit == "m/sec/sec" || unit == "m/sec2" || unit == "m/s²") {
    unit = "m/s2";
  } else if (unit == "g's" || unit == "gs") {
    unit = "g";
  }
  for (const auto& [name, value] : known) {
    if (unit == name) return value;
  }
  return {};
}

MotionDirection parse_direction(std::string_view words) {
  MotionDirection direction;
  const std::string text = lower(trim(words));
  std::string_view all = text;
  if (all.ends_with("deg")) all = trim(all.substr(0, all.size() - 3));
  const auto any_of = [&](std::initializer_list<std::string_view> known) {
    return std::find(known.begin(), known.end(), all) != known.end();
  };
  direction.downwards = any_of({"down", "dwn", "dn"});
  direction.vertical = direction.downwards || any_of({"up", "ver", "vert", "vertical", "v", "z"});
  if (const auto degrees = parse_number(all); degrees && *degrees >= 0.0 && *degrees <= 360.0) {
    direction.azimuth = *degrees;
  } else if (all.size() >= 3 && (all.front() == 'n' || all.front() == 's') &&
             (all.back() == 'e' || all.back() == 'w')) {
    // A quadrant bearing: N21E is 21° east of north.
    const auto bearing = parse_number(all.substr(1, all.size() - 2));
    if (bearing && *bearing >= 0.0 && *bearing <= 90.0) {
      const double eastwards = all.back() == 'e' ? *bearing : -*bearing;
      direction.azimuth = all.front() == 'n' ? std::fmod(360.0 + eastwards, 360.0) : 180.0 - eastwards;
    }
  }
  return direction;
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

}  // namespace keyblock::loading
