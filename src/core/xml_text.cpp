#include "core/xml_text.h"

#include "core/text.h"

namespace keyblock {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";  // U+FFFD

// A character of several bytes; XML has neither U+FFFE nor U+FFFF.
std::string_view beyond_ascii(std::string_view text, std::size_t at) {
  const std::string_view character = text.substr(at, utf8_length(text, at));
  const bool none = character.empty() || character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF";
  return none ? replacement : character;
}

}  // namespace

std::string xml_text(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (static_cast<unsigned char>(c) >= 0x80U) {
      out += beyond_ascii(text, at);
      if (const std::size_t length = utf8_length(text, at); length > 1) at += length - 1;
      continue;
    }
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= ' ' || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

}  // namespace keyblock
