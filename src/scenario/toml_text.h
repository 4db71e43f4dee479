#pragma once
#include <string>

#include "scenario/value.h"

namespace keyblock::scenario {

/// A document as a person would write it: a header for every table and every element of a list of tables, one key a line, what lies deeper
/// in braces. Reading it gives the same values.
std::string toml_text(const Value& document);

}  // namespace keyblock::scenario
