#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/checked_json.h"
#include "core/error.h"

/// What commands print with --json, for other programs.
namespace keyblock::app {

/// A list of objects: file, line, column, key, found, expected, hint.
nlohmann::ordered_json mistakes_json(const std::vector<Diagnostic>& mistakes);

/// JSON to standard output as it stands, but for what a terminal obeys: that is escaped within the strings.
void print_json_text(std::string_view text);
/// To standard output, in several lines. Bytes that are no UTF-8 become U+FFFD.
void print_json(const nlohmann::ordered_json& json);

}  // namespace keyblock::app
