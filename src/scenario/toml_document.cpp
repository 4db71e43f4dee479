// The parser of toml++ 3.3 asserts, or without assertions lets the compiler assume, what some malformed files violate
// (`[ = ]`), just before it finds the mistake itself and reports it. So: no assertions, and no assumptions either.
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "core/text.h"
#include "scenario/key_path.h"
#include "scenario/value.h"

namespace keyblock::scenario {
namespace {

SourcePosition position(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value convert(const toml::node& node, const std::string& file) {
  Value value;
  value.where = position(node.source(), file);
  if (const auto* table = node.as_table()) {
    for (const auto& [key, member] : *table) {
      Value& item = value.items.emplace_back(convert(member, file));
      item.key = std::string(key.str());
      item.key_where = position(key.source(), file);
    }
    std::stable_sort(value.items.begin(), value.items.end(), [](const Value& a, const Value& b) {
      return std::tie(a.key_where.line, a.key_where.column) < std::tie(b.key_where.line, b.key_where.column);
    });
  } else if (const auto* array = node.as_array()) {
    value.type = Value::Type::array;
    for (const toml::node& element : *array) value.items.push_back(convert(element, file));
  } else if (const auto* text = node.as_string()) {
    value.type = Value::Type::string;
    value.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.type = Value::Type::integer;
    value.integer = integer->get();
    value.number = static_cast<double>(value.integer);
  } else if (const auto* number = node.as_floating_point()) {
    value.type = Value::Type::number;
    value.number = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    value.type = Value::Type::boolean;
    value.boolean = boolean->get();
  } else {
    std::ostringstream date;
    node.visit([&](const auto& n) {
      if constexpr (toml::is_chronological<decltype(n)>) date << n;
    });
    value.type = Value::Type::date;
    value.text = date.str();
  }
  return value;
}

// Finds what the parser of toml++ 3.3 does not survive: characters beyond ASCII outside of strings and comments, where
// TOML has none and it has undefined behaviour for some of them, and tables so deep in each other that its recursion, and
// ours, runs out of stack. Up to the first mistake in the text this walks as the parser does.
class Hazards {
 public:
  explicit Hazards(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // byte order mark
  }

  // Offset of the first one, or npos.
  std::size_t find() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      follow(c);
      if (static_cast<unsigned char>(c) >= 0x80 || is_too_deep(c)) return at_;
      if (c == '#') at_ = std::min(text_.find('\n', at_), text_.size());
      if ((c == '"' || c == '\'') && begins_string()) skip_string(c);
    }
    return std::string_view::npos;
  }

 private:
  // A quote within a number, a name or other signs begins no string: the parser reads on to the end of the value, and finds a mistake.
  [[nodiscard]] bool begins_string() const {
    const char before = at_ > 0 ? text_[at_ - 1] : '\n';
    return std::string_view(" \t\r\n=,[{").find(before) != std::string_view::npos ||
           (before == '.' && !in_value_);
  }

  // Whether a value is read or a key.
  void follow(char c) {
    if (c == '=') in_value_ = true;
    if (c == '\n' && open_.empty()) in_value_ = false;
    if (c == '[') open_ += in_value_ ? '[' : '(';  // a list, or the header of a table
    if (c == '{') open_ += c;
    if (c == '{') in_value_ = false;
    if (c == ',') in_value_ = !open_.empty() && open_.back() == '[';
    if ((c == ']' || c == '}') && !open_.empty()) {
      in_value_ = open_.back() != '(';
      open_.pop_back();
    }
  }

  // Whether tables and lists, or the points of a key, are too many.
  bool is_too_deep(char c) {
    if (std::string_view("[]{},=\n").find(c) != std::string_view::npos) points_ = 0;
    if (c == '.') ++points_;
    return std::ssize(open_) > deepest_path || points_ >= deepest_path;
  }

  // Moves to the last character of the string that begins here.
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool multi_line = text_.substr(at_).starts_with(three);
    for (at_ += multi_line ? 3 : 1; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\\' && quote == '"') {
        ++at_;
      } else if (multi_line && text_.substr(at_).starts_with(three)) {
        at_ += 2;
        while (at_ + 1 < text_.size() && text_[at_ + 1] == quote) ++at_;  // up to two quotes before the end
        return;
      } else if (!multi_line && (text_[at_] == quote || text_[at_] == '\n')) {
        return;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string open_;  ///< brackets
  bool in_value_ = false;
  int points_ = 0;
};

bool continues_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

// The UTF-8 character at `at`, and its code point.
std::string character_at(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && continues_character(text[end])) ++end;
  const auto lead = static_cast<unsigned char>(text[at]);
  unsigned code = end - at == 2 ? lead & 0x1FU : end - at == 3 ? lead & 0x0FU : lead & 0x07U;
  for (std::size_t k = at + 1; k < end; ++k)
    code = code << 6U | (static_cast<unsigned char>(text[k]) & 0x3FU);
  return fmt::format("the character '{}' (U+{:04X})", text.substr(at, end - at), code);
}

// Line and column of a byte, the columns counted in characters.
SourcePosition position_at(std::string_view text, std::size_t at, const std::string& file) {
  const std::string_view before = text.substr(0, at);
  const std::size_t newline = before.rfind('\n');
  const std::string_view line = before.substr(newline == std::string_view::npos ? 0 : newline + 1);
  return {file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(line.size() - static_cast<std::size_t>(std::count_if(line.begin(), line.end(),
                                                                                    continues_character)))};
}

void refuse_other_encodings(std::string_view text, const std::string& file) {
  const std::size_t at = find_invalid_utf8(text);
  if (at == std::string_view::npos) return;
  Diagnostic diagnostic;
  diagnostic.where = position_at(text, at, file);
  diagnostic.found =
      fmt::format("the byte 0x{:02X}, which is no UTF-8", static_cast<unsigned char>(text[at]));
  diagnostic.expected = "text in UTF-8";
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    diagnostic.hint = "the file seems to be in UTF-16; save it as UTF-8";
  throw InputError(std::move(diagnostic));
}

void refuse_hazards(std::string_view text, const std::string& file) {
  const std::size_t at = Hazards(text).find();
  if (at == std::string_view::npos) return;
  Diagnostic diagnostic;
  diagnostic.where = position_at(text, at, file);
  if (static_cast<unsigned char>(text[at]) < 0x80) {
    diagnostic.found = fmt::format("more than {} tables or lists in each other", deepest_path);
    diagnostic.expected = "keys and values of fewer levels";
  } else {
    diagnostic.found = character_at(text, at);
    diagnostic.expected = "letters, digits and signs of ASCII outside of strings and comments";
  }
  throw InputError(std::move(diagnostic));
}

}  // namespace

Value parse_toml(std::string_view text, const std::string& file) {
  refuse_other_encodings(text, file);
  refuse_hazards(text, file);
  try {
    return convert(toml::parse(text, file), file);
  } catch (const toml::parse_error& error) {
    Diagnostic diagnostic;
    diagnostic.where = position(error.source(), file);
    diagnostic.found = "text that is not TOML (" + std::string(error.description()) + ")";
    diagnostic.expected = "key = value, [table] or [[list]]";
    throw InputError(std::move(diagnostic));
  }
}

}  // namespace keyblock::scenario
