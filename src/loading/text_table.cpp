#include "loading/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyblock::loading {
namespace {

// Steps that differ by less than this share of their mean count as equal: times are often rounded to few
// digits.
constexpr double even_spacing_tolerance = 1e-3;

// s. Beyond it the spacing of numbers is coarser than steps of records.
constexpr double longest_time = 1e10;

// A number with a decimal point, or with a decimal comma where commas do not part fields.
std::optional<double> field_number(std::string_view field, char separator) {
  if (separator == ',' || field.find(',') == std::string_view::npos) return parse_number(field);
  std::string digits(field);
  const std::size_t comma = digits.find(',');
  if (digits.find('.') != std::string::npos || digits.find(',', comma + 1) != std::string::npos) return {};
  digits[comma] = '.';
  return parse_number(digits);
}

bool all_numbers(std::string_view line, char separator) {
  const auto fields = split_fields(line, separator);
  return std::all_of(fields.begin(), fields.end(),
                     [&](std::string_view field) { return field_number(field, separator).has_value(); });
}

class RowReader {
 public:
  RowReader(const MotionText& text, char separator) : text_(text), separator_(separator) {}

  void add(std::size_t line, TextTable& table) {
    const std::string_view row = text_.line(line);
    const auto fields = split_fields(row, separator_);
    if (table.columns.empty()) table.columns.resize(fields.size());
    const std::size_t count = table.columns.size();
    const std::string expected =
        count == 1 ? "one finite number" : fmt::format("{} finite numbers: time and accelerations", count);
    if (fields.size() != count)
      text_.fail(line, 1, fmt::format("{} fields in {}", fields.size(), quoted_text(row)), expected,
                 "text that is no table is read with skip, column, dt and unit");
    for (std::size_t c = 0; c < count; ++c) {
      const auto value = field_number(fields[c], separator_);
      const auto column = static_cast<std::size_t>(fields[c].data() - row.data()) + 1;
      if (!value) text_.fail(line, column, quoted_text(fields[c]), expected);
      check_sign(line, column, fields[c]);
      table.columns[c].push_back(*value);
    }
    table.lines.push_back(line);
  }

 private:
  void check_sign(std::size_t line, std::size_t column, std::string_view field) {
    if (separator_ == ',') return;
    points_ = points_ || field.find('.') != std::string_view::npos;
    commas_ = commas_ || field.find(',') != std::string_view::npos;
    if (points_ && commas_)
      text_.fail(line, column, quoted_text(field), "decimal points only, or decimal commas only");
  }

  const MotionText& text_;
  char separator_;
  bool points_ = false, commas_ = false;
};

}  // namespace

bool is_comment(std::string_view line) {
  line = trim(line);
  return line.empty() || line.front() == '#' || line.front() == '%' || line.front() == '!' ||
         line.starts_with("//");
}

std::vector<std::string_view> split_fields(std::string_view line, char separator) {
  const bool blanks = separator == ' ';
  const std::string_view parting = blanks ? " \t" : separator == ';' ? ";" : ",";
  std::vector<std::string_view> fields;
  line = trim(line);
  for (;;) {
    const std::size_t end = line.find_first_of(parting);
    fields.push_back(trim(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
    if (blanks) line = trim(line);
  }
}

std::optional<char> row_separator(std::string_view line) {
  const bool semicolon = line.find(';') != std::string_view::npos;
  if (semicolon) return all_numbers(line, ';') ? std::optional(';') : std::nullopt;
  if (line.find(',') != std::string_view::npos && all_numbers(line, ',')) return ',';
  return all_numbers(line, ' ') ? std::optional(' ') : std::nullopt;
}

TextTable read_rows(const MotionText& text, std::size_t first) {
  while (first < text.size() && is_comment(text.line(first))) ++first;
  const auto separator = row_separator(text.line(first));
  if (!separator) text.fail(first, "a row of finite numbers");
  RowReader reader(text, *separator);
  TextTable table;
  for (std::size_t k = first; k < text.size(); ++k) {
    if (!is_comment(text.line(k))) reader.add(k, table);
  }
  return table;
}

void set_times(const MotionText& text, const TextTable& table, double seconds, MotionComponent& component) {
  std::vector<double> times = table.columns.front();
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::string found = fmt::format("time {}", times[k]);
    if (k > 0 && !(times[k] > times[k - 1]))
      text.fail(table.lines[k], 1, found, fmt::format("a time after {}", times[k - 1]));
    if (!(std::abs(times[k]) <= longest_time))
      text.fail(table.lines[k], 1, found, fmt::format("a time within ±{} s", longest_time));
  }
  if (times.size() < 2) text.fail(text.size() - 1, "at least two rows of time and acceleration");
  for (double& time : times) time *= seconds;
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  if (!is_time_step(mean)) {
    text.fail(text.size() - 1, 1, fmt::format("times from {} to {}", times.front(), times.back()),
              std::string(time_step_text) + ", on average");
  }
  component.start = times.front();
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

}  // namespace keyblock::loading
