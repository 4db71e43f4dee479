#include "drawing/dxf_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/text.h"
#include "drawing/refuse.h"

namespace keyblock::drawing {
namespace {

constexpr std::size_t longest_shown = 40;

std::string_view without_spaces(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// Lines end with LF, CR LF, or CR alone.
std::string_view next_line(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end);
  const std::size_t mark = text.starts_with("\r\n") ? 2 : 1;
  text.remove_prefix(std::min(mark, text.size()));
  return without_spaces(line);
}

}  // namespace

const Pair* Record::find(int code) const {
  const auto found = std::ranges::find(pairs, code, &Pair::code);
  return found == pairs.end() ? nullptr : &*found;
}

std::string_view Record::text(int code) const {
  const Pair* pair = find(code);
  return pair == nullptr ? std::string_view() : pair->value;
}

Records read_records(std::string_view text, const std::string& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  Records all;
  bool ended = false;
  int line = 0;
  while (!text.empty() && !ended) {
    const std::string_view code_text = next_line(text);
    ++line;
    if (code_text.empty() && text.empty()) break;
    Pair pair;
    const auto [end, error] =
        std::from_chars(code_text.data(), code_text.data() + code_text.size(), pair.code);
    if (error != std::errc() || end != code_text.data() + code_text.size())
      refuse(file, line, "", '"' + printable(code_text, longest_shown) + '"',
             "a group code of DXF, a whole number");
    pair.value = next_line(text);
    pair.line = ++line;
    ended = pair.code == 0 && pair.value == "EOF";
    constexpr int comment = 999;
    if (pair.code != comment) all.pairs.push_back(pair);
  }
  if (!ended)
    refuse(file, line, "", "the end of the file", "the record EOF, with which a drawing ends",
           "the file is not whole: copy or save it again");
  for (std::size_t k = 0; k < all.pairs.size();) {
    std::size_t next = k + 1;
    while (next < all.pairs.size() && all.pairs[next].code != 0) ++next;
    const Pair& first = all.pairs[k];
    if (first.code == 0)
      all.records.push_back({first.value, first.line, std::span(all.pairs).subspan(k + 1, next - k - 1)});
    k = next;
  }
  return all;
}

double Numbers::number(const Pair& pair) const {
  std::string_view text = pair.value;
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    refuse(file_, pair.line, "", '"' + printable(pair.value, longest_shown) + '"',
           fmt::format("a finite number (group code {})", pair.code));
  return value;
}

double Numbers::number(const Record& record, int code, double fallback) const {
  const Pair* pair = record.find(code);
  return pair == nullptr ? fallback : number(*pair);
}

int Numbers::integer(const Record& record, int code, int fallback) const {
  const Pair* pair = record.find(code);
  if (pair == nullptr) return fallback;
  const double value = number(*pair);
  constexpr double most = 2e9;
  if (std::abs(value) > most || value != std::floor(value))
    refuse(file_, pair->line, "", std::string(pair->value),
           fmt::format("a whole number (group code {})", code));
  return static_cast<int>(value);
}

Vec2 Numbers::point(const Record& record, int code) const {
  return {number(record, code, 0.0), number(record, code + 10, 0.0)};
}

std::vector<double> Numbers::all(const Record& record, int code) const {
  std::vector<double> values;
  for (const Pair& pair : record.pairs) {
    if (pair.code == code) values.push_back(number(pair));
  }
  return values;
}

std::vector<Vec2> Numbers::points(const Record& record, int code) const {
  std::vector<Vec2> values;
  for (const Pair& pair : record.pairs) {
    if (pair.code == code) values.push_back({number(pair), 0.0});
    if (pair.code == code + 10 && !values.empty()) values.back().y = number(pair);
  }
  return values;
}

}  // namespace keyblock::drawing
