#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace keyblock::scenario {

/// Most segments of a key path, and most brackets within brackets of a file.
constexpr int deepest_path = 32;

/// A step of a key path: a key of a table, or the name or place of an element of a list.
struct PathSegment {
  std::string key;  ///< the key or name; digits of an index, too
  /// Place in a list, counted from 0: written `[2]`, or `.2` where no element bears that name.
  std::optional<std::size_t> index;
};

/// Parses `stage.'first earthquake'.scale`, `stage.0.scale`, `stage[0].scale`: segments separated by points, bare
/// or in single or double quotes. Empty when the text is no path.
std::optional<std::vector<PathSegment>> parse_key_path(std::string_view text);

/// One segment as parse_key_path reads it: quoted where needed.
std::string path_segment(std::string_view key);
/// `path.key`, or the key alone when the path is empty.
std::string join_path(std::string_view path, std::string_view key);
std::string join_index(std::string_view path, std::size_t index);
/// An element of a list of tables: by its name, or by its index where it has none.
inline std::string join_element(std::string_view list, std::string_view name, std::size_t index) {
  return name.empty() ? join_index(list, index) : join_path(list, name);
}

/// The candidate that `word` was probably meant to be: the only one that begins with it (four letters or more), or that differs least, by
/// one letter left out, put in, swapped with its neighbour or, which counts a little more, replaced; two in words of nine letters and more.
/// Capitals do not count. Empty when there is none, or two are as near.
std::string closest_word(std::string_view word, const std::vector<std::string>& candidates);

/// `did you mean 'friction'?`, or nothing.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

/// `"a", "b" or "c"`.
std::string list_words(const std::vector<std::string>& words, std::string_view last = " or ");

}  // namespace keyblock::scenario
