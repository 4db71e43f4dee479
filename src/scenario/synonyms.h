#pragma once
#include <span>
#include <string_view>

/// Words that users bring along from other programs and from daily speech: the one place where they stand.
///
/// Words are compared without capitals, underscores, hyphens and apostrophes, and are separated by blanks.
namespace keyblock::scenario {

/// Words for a key, a table, or a word that stands as a value. `keys` are those that may be meant, the likeliest first.
struct Synonym {
  std::string_view words, keys;
  bool anywhere = false;  ///< says what is meant in any table, not only in one that has the key
};
std::span<const Synonym> synonyms();

/// Words of which a sentence says what is here in their place, or that the program has no such thing.
struct Explanation {
  std::string_view words, text;
};
std::span<const Explanation> explanations();

}  // namespace keyblock::scenario
