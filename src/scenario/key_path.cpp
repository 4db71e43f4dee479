#include "scenario/key_path.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace keyblock::scenario {
namespace {

bool is_bare(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
}

std::optional<std::size_t> parse_index(std::string_view digits) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return index;
}

// Reads one segment off the front of `text`.
std::optional<PathSegment> take_segment(std::string_view& text) {
  PathSegment segment;
  std::size_t end = 0;
  if (text.front() == '\'' || text.front() == '"') {
    end = text.find(text.front(), 1);
    if (end == std::string_view::npos) return std::nullopt;
    segment.key = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    return segment;
  }
  if (text.front() == '[') {
    end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    segment.key = text.substr(1, end - 1);
    segment.index = parse_index(segment.key);
    text.remove_prefix(end + 1);
    return segment.index ? std::optional(segment) : std::nullopt;
  }
  while (end < text.size() && is_bare(text[end])) ++end;
  segment.key = text.substr(0, end);
  segment.index = parse_index(segment.key);
  text.remove_prefix(end);
  return segment.key.empty() ? std::nullopt : std::optional(segment);
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

// What a slip of the keyboard costs: a letter that is replaced is a letter less that was meant.
constexpr std::size_t left_out = 4, put_in = 4, swapped = 4, replaced = 5;

// Edits between two words, a swap of neighbours counting once (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = left_out * j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = put_in * i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min(
          {last[j] + put_in, row[j - 1] + left_out, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : replaced)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + swapped);
      }
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::vector<PathSegment>> parse_key_path(std::string_view text) {
  std::vector<PathSegment> path;
  while (!text.empty()) {
    if (!path.empty() && text.front() == '.') {
      text.remove_prefix(1);
      if (text.empty()) return std::nullopt;
    } else if (!path.empty() && text.front() != '[') {
      return std::nullopt;
    }
    auto segment = take_segment(text);
    if (!segment) return std::nullopt;
    path.push_back(std::move(*segment));
  }
  return path.empty() ? std::nullopt : std::optional(path);
}

std::string path_segment(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), is_bare);
  if (bare) return std::string(key);
  const char quote = key.find('\'') == std::string_view::npos ? '\'' : '"';
  return quote + std::string(key) + quote;
}

std::string join_path(std::string_view path, std::string_view key) {
  return (path.empty() ? std::string() : std::string(path) + ".") + path_segment(key);
}

std::string join_index(std::string_view path, std::size_t index) {
  return std::string(path) + "[" + std::to_string(index) + "]";
}

std::string closest_word(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t least_letters = 3, many_letters = 9, least_beginning = 4;
  const std::size_t slips = word.size() < least_letters ? 0 : word.size() < many_letters ? 1 : 2;
  const std::size_t most = slips * replaced;
  const std::string written = lower_case(word);
  std::string best;
  std::size_t least = most + 1;
  bool is_only_one = true;
  for (const std::string& candidate : candidates) {
    const std::string known = lower_case(candidate);
    const bool begins = written.size() >= least_beginning && known.starts_with(written);
    std::size_t distance = edit_distance(written, known);
    if (begins) distance = std::min(distance, most);
    if (distance > most || distance > least || candidate == best) continue;
    is_only_one = distance < least;
    least = distance;
    best = candidate;
  }
  return is_only_one ? best : "";
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string best = closest_word(word, candidates);
  return best.empty() ? "" : "did you mean '" + best + "'?";
}

std::string list_words(const std::vector<std::string>& words, std::string_view last) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? std::string(last) : ", ";
    text += '"' + words[k] + '"';
  }
  return text;
}

}  // namespace keyblock::scenario
