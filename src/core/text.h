#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace keyblock {

/// Bytes of the UTF-8 character that begins at `at`, which lies within the text; 0 when none does (RFC 3629: no overlong forms, no
/// surrogates, nothing beyond U+10FFFF).
std::size_t utf8_length(std::string_view text, std::size_t at);

/// Offset of the first byte that belongs to no UTF-8 character, or npos.
std::size_t find_invalid_utf8(std::string_view text);

/// Whether a terminal obeys a UTF-8 character in place of showing it: control characters (C0, DEL, C1), line separators, and those that turn
/// the direction of writing, by which text looks like other text.
bool is_control(std::string_view character);

/// Text of several lines without what a terminal obeys but line breaks and tabs: control characters and bytes that are no UTF-8 are
/// written as \x1b.
std::string harmless(std::string_view text);

/// JSON with what a terminal obeys within its strings written as \u009b: the same values to whoever reads it. Line breaks between values stay.
std::string harmless_json(std::string_view json);

/// Text as it may stand on one line of a message, whatever it holds: control characters and bytes that are no UTF-8 are
/// written as \n, \t, \r and \x1b. What is longer than `longest` characters ends there, with `…`.
std::string printable(std::string_view text, std::size_t longest);

}  // namespace keyblock
