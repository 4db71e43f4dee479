#pragma once
#include <optional>
#include <string>
#include <vector>

#include "scenario/key_path.h"
#include "scenario/value.h"

namespace keyblock::scenario {

/// A value to be put in the place of what the file says, or beside it.
struct Override {
  std::vector<PathSegment> path;
  Value value;  ///< its position is that of the override
};

/// Parses `key=value` as given to --set. The value is TOML; what is no TOML value is taken as a string, so that
/// words need no quotes. Positions name `--set key=value` as the file, its beginning where it is long. Throws InputError.
Override parse_override(const std::string& text);

/// The same from a key path and a value at hand. Throws InputError, at the position of the value, when `path` is no
/// key path.
Override make_override(const std::string& path, Value value);

/// Sets the value in the document. Tables on the way that do not exist are made; elements of lists must exist.
/// Returns what is wrong with the path, if anything; the document is then unchanged. Whether the key has a meaning
/// is seen when the document is read.
std::optional<Diagnostic> apply_override(const Override& override_, Value& document);

/// Whether the first keys of a path are those of another, or all of them.
bool begins_with(const std::vector<PathSegment>& path, const std::vector<PathSegment>& first);

/// The value that a key path leads to, or null.
const Value* find_value(const std::vector<PathSegment>& path, const Value& document);
Value* find_value(const std::vector<PathSegment>& path, Value& document);

/// Takes out what a key path leads to; false where there is nothing.
bool remove_value(std::vector<PathSegment> path, Value& document);

/// Where a key path leads in the document: its keys, and for elements of lists their places in brackets. Paths to the same value
/// are equal here, however they are written.
std::vector<std::string> resolved_path(const std::vector<PathSegment>& path, const Value& document);

}  // namespace keyblock::scenario
