#pragma once
#include <string>
#include <string_view>

namespace keyblock {

/// Text as it may stand in XML and HTML, between tags and in attributes: & < > " ' by name; control characters other than tab and
/// new line, which XML does not have, left out; U+FFFD for bytes that are no UTF-8.
std::string xml_text(std::string_view text);

}  // namespace keyblock
