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

namespace keyblock::loading {
namespace {

bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
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

// Bytes of Latin-1 as UTF-8.
std::string from_latin_1(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80U) {
      text += c;
    } else {
      text += static_cast<char>(0xC0U | (code >> 6U));
      text += static_cast<char>(0x80U | (code & 0x3FU));
    }
  }
  return text;
}

}  // namespace

MotionText::MotionText(std::string file, std::string content)
    : file_(std::move(file)), content_(std::move(content)) {
  if (find_invalid_utf8(content_) != std::string_view::npos) content_ = from_latin_1(content_);
  std::string_view all = content_;
  if (all.starts_with("\xEF\xBB\xBF")) all.remove_prefix(3);
  const char line_end = all.find('\n') == std::string_view::npos ? '\r' : '\n';
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find(line_end, begin), all.size());
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

void MotionText::add_numbers(std::size_t line, std::size_t count, std::size_t width, const std::string& what,
                             std::vector<double>& values) const {
  const std::string_view row = lines_[line];
  const bool free = width == 0 || row.find('\t') != std::string_view::npos;
  for (std::size_t begin = 0; begin < row.size();) {
    std::size_t end = begin + width;
    if (free) {
      while (begin < row.size() && (is_blank(row[begin]) || row[begin] == ',')) ++begin;
      if (begin == row.size()) break;
      end = free_field_end(row, begin);
    }
    const std::string_view field = row.substr(begin, end - begin);
    if (values.size() == count) {
      fail(line, begin + 1, quoted_text(field), fmt::format("the end of the line after {} {}", count, what));
    }
    const auto value = parse_number(field);
    if (!value) {
      fail(line, begin + 1, quoted_text(field),
           fmt::format("a finite number ({} {} read so far)", values.size(), what));
    }
    values.push_back(*value);
    begin = end;
  }
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
    add_numbers(k, count, width, what, values);
  }
  if (k == lines_.size() && count > 1) check_last_number(k - 1);
  if (next_line != nullptr) *next_line = k;
  return values;
}

// Where the line end is missing, and the last number has fewer decimals than the one before it, the rest of the number is missing, too.
void MotionText::check_last_number(std::size_t line) const {
  if (content_.ends_with('\n') || content_.ends_with('\r')) return;
  const auto decimals = [](std::string_view text) {
    const std::size_t point = text.rfind('.');
    return point == std::string_view::npos ? 0 : text.size() - point;
  };
  const std::string_view row = lines_[line];
  const std::size_t begin = row.find_last_of(" \t,") + 1;
  std::string_view before = trim(row.substr(0, begin));
  if (before.empty() && line > 0) before = lines_[line - 1];
  before = before.substr(0, before.find_last_not_of(" \t,\r") + 1);
  before = before.substr(before.find_last_of(" \t,") + 1);
  if (decimals(row.substr(begin)) < decimals(before))
    fail(line, begin + 1, quoted_text(row.substr(begin)), "as many decimals as in the number before it",
         "the file may have been cut short");
}

std::vector<double> MotionText::numbers_to_end(std::size_t first, bool (*skipped)(std::string_view)) const {
  std::vector<double> values;
  for (std::size_t k = first; k < lines_.size(); ++k) {
    if (!skipped(lines_[k])) add_numbers(k, content_.size(), 0, "samples", values);
  }
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
  const std::string found = line < lines_.size() ? quoted_text(lines_[line]) : "the end of the file";
  fail(line < lines_.size() ? line : lines_.size(), 1, found, std::move(expected));
}

void MotionText::refuse(std::string found, std::string expected, std::string hint) const {
  refuse_file(file_, std::move(found), std::move(expected), std::move(hint));
}

void refuse_file(const std::string& file, std::string found, std::string expected, std::string hint) {
  Diagnostic diagnostic;
  diagnostic.where.file = file;
  diagnostic.found = std::move(found);
  diagnostic.expected = std::move(expected);
  diagnostic.hint = std::move(hint);
  throw InputError(std::move(diagnostic));
}

std::string quoted_text(std::string_view text) {
  constexpr std::size_t longest = 40;
  text = trim(text);
  return text.empty() ? std::string("a blank field") : '"' + printable(text, longest) + '"';
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

std::optional<std::size_t> column_width(std::string_view text) {
  const std::size_t open = text.rfind('(');
  if (open == std::string_view::npos) return {};
  const std::size_t letter = text.find_first_of("FEGIfegi", open);
  if (letter == std::string_view::npos) return {};
  const std::string_view digits =
      text.substr(letter + 1, text.find_first_not_of("0123456789", letter + 1) - letter - 1);
  constexpr double widest = 100.0;
  const auto width = parse_number(digits);
  if (!width || !(*width >= 1.0 && *width <= widest)) return {};
  return static_cast<std::size_t>(*width);
}

}  // namespace keyblock::loading
