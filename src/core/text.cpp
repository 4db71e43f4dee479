#include "core/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace keyblock {
namespace {

/// Of a UTF-8 character.
char32_t code_point(std::string_view character) {
  constexpr std::array<unsigned, 4> of_first{0x7FU, 0x1FU, 0x0FU, 0x07U};
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(character[k]); };
  char32_t code = byte(0) & of_first.at(character.size() - 1);
  for (std::size_t k = 1; k < character.size(); ++k) code = code << 6U | (byte(k) & 0x3FU);
  return code;
}

std::string escaped(char c) {
  if (c == '\n') return "\\n";
  if (c == '\t') return "\\t";
  if (c == '\r') return "\\r";
  return fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
}

/// Bytes of a character that begins with `lead`; 0: none does.
std::size_t length_after(unsigned lead) {
  if (lead < 0x80U) return 1;
  if (lead < 0xC2U) return 0;
  if (lead < 0xE0U) return 2;
  if (lead < 0xF0U) return 3;
  return lead < 0xF5U ? 4 : 0;
}

/// A sequence of more bytes than its character needs, half of a surrogate pair, or one beyond the last character.
bool is_no_character(unsigned lead, unsigned second) {
  const bool overlong = (lead == 0xE0U && second < 0xA0U) || (lead == 0xF0U && second < 0x90U);
  const bool surrogate = lead == 0xEDU && second >= 0xA0U;
  const bool beyond = lead == 0xF4U && second >= 0x90U;
  return overlong || surrogate || beyond;
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) {
    return at + k < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[at + k])) : 0U;
  };
  const unsigned lead = byte(0);
  const std::size_t length = length_after(lead);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
  }
  return is_no_character(lead, byte(1)) ? 0 : length;
}

std::size_t find_invalid_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

bool is_control(std::string_view character) {
  const char32_t code = code_point(character);
  return code < 0x20U || (code >= 0x7FU && code < 0xA0U) || (code >= 0x2028U && code <= 0x202EU) ||
         (code >= 0x2066U && code <= 0x2069U);
}

namespace {

// Calls add(shown, as it stands) for every character, which is shown escaped where it is a control character or none at all, as long as
// that returns true.
template <class Add>
void for_characters(std::string_view text, const Add& add) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    const std::string_view character = text.substr(at, std::max<std::size_t>(length, 1));
    at += character.size();
    std::string code;
    if (length == 0 || is_control(character)) {
      for (const char c : character) code += escaped(c);
    }
    if (!add(code.empty() ? character : code, character)) return;
  }
}

}  // namespace

std::string harmless(std::string_view text) {
  std::string out;
  for_characters(text, [&](std::string_view shown, std::string_view character) {
    out += character == "\n" || character == "\t" ? character : shown;
    return true;
  });
  return out;
}

std::string harmless_json(std::string_view json) {
  std::string out;
  for (std::size_t at = 0; at < json.size();) {
    const std::string_view character = json.substr(at, std::max<std::size_t>(utf8_length(json, at), 1));
    at += character.size();
    // Others of one byte are escaped within strings already, as JSON has it.
    const bool is_obeyed = (character.size() > 1 || character == "\x7f") && is_control(character);
    out += is_obeyed ? fmt::format("\\u{:04x}", static_cast<unsigned>(code_point(character)))
                     : std::string(character);
  }
  return out;
}

std::string printable(std::string_view text, std::size_t longest) {
  std::string out;
  std::size_t count = 0;
  for_characters(text, [&](std::string_view shown, std::string_view /*character*/) {
    out += count == longest ? "…" : shown;
    return count++ < longest;
  });
  return out;
}

}  // namespace keyblock
