#pragma once
#include <optional>
#include <string>
#include <vector>

namespace keyblock::scenario {

/// What kind of value a key holds.
enum class KeyKind {
  any,  ///< more than one kind, or one that only the reader knows
  number,
  integer,
  boolean,
  string,
  word,        ///< one of KeyType::words
  point,       ///< [x, y]
  interval,    ///< [from, to]
  points,      ///< [[x, y], …]
  rings,       ///< [[[x, y], …], …]
  lines,       ///< likewise, of two points or more
  rows,        ///< [[time, value], …]
  references,  ///< names of other elements, or words
  list,        ///< of whatever there may be
  numbers,     ///< a table of numbers by name
  table,
  tables,  ///< list of them
  group,   ///< a table with a section of its own, or what stands in its place
};

/// The same with what bounds it.
struct KeyType {
  KeyKind kind = KeyKind::any;
  std::vector<std::string> words{};
  std::optional<double> above{}, at_least{}, at_most{}, below{};  ///< of numbers
  std::string group{};                                            ///< title of its section
  std::vector<KeyKind> kinds{};  ///< of `any` all that it may be, of `group` what may stand in its place
  bool required = false;         ///< whatever else is there
};

/// One key of the scenario as the reference shows it.
struct KeyReference {
  std::string key;       ///< within its section: `young`, `components.file`
  std::string type;      ///< with range and allowed words
  std::string fallback;  ///< default, or "required"
  std::string unit;
  std::string meaning;  ///< with the condition under which it is used
  KeyType value_type;
};

/// The keys of one table.
struct SectionReference {
  std::string title;  ///< `[rock]`, `[[joint_set]]`; empty for the keys outside all tables
  std::string meaning;
  std::vector<KeyReference> keys;
  bool may_be_alone = false;  ///< of a list of tables: one table may stand in its place
};

/// Every section and key, in the order in which they are read.
std::vector<SectionReference> key_reference();

/// The unit of what a key path leads to, as the reference has it: "Pa", "°"; empty where it has none, or is not known.
std::string key_unit(const std::string& path);

/// Every section as Markdown, the body of docs/scenario.md.
std::string scenario_reference();

}  // namespace keyblock::scenario
