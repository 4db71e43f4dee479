#pragma once
#include <string>
#include <vector>

namespace keyblock::scenario {

/// One key of the scenario as the reference shows it.
struct KeyReference {
  std::string key;       ///< within its section: `young`, `components.file`
  std::string type;      ///< with range and allowed words
  std::string fallback;  ///< default, or "required"
  std::string unit;
  std::string meaning;  ///< with the condition under which it is used
};

/// The keys of one table.
struct SectionReference {
  std::string title;  ///< `[rock]`, `[[joint_set]]`; empty for the keys outside all tables
  std::string meaning;
  std::vector<KeyReference> keys;
};

/// Every section and key, in the order in which they are read.
std::vector<SectionReference> key_reference();

/// The same as Markdown, the body of docs/scenario.md.
std::string scenario_reference();

}  // namespace keyblock::scenario
