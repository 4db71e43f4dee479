#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::scenario {

/// What somebody who wrote the unknown key `word` in a table with the keys `known` may have meant: a key of the table that is spelled
/// like it or is another word for it, or where else such a key belongs, or that the program has no such thing. Nothing rather than a
/// guess.
std::string key_hint(std::string_view word, const std::vector<std::string>& known);

/// Likewise for a word that stands as a value, where one of `allowed` is expected.
std::string value_hint(std::string_view word, const std::vector<std::string>& allowed);

}  // namespace keyblock::scenario
