#pragma once
#include <string>

namespace keyblock::scenario {

/// A JSON Schema (draft 7) of scenarios, made of the descriptions that the reader itself gives: keys, kinds, ranges, words, units, meanings.
/// Editors complete keys by it and underline mistakes as one types. It accepts every scenario that the program reads, and more: what
/// several keys are together, `keyblock check` says.
std::string schema();

}  // namespace keyblock::scenario
