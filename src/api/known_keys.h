#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "keyblock/scenario.h"
#include "scenario/key_reference.h"

namespace keyblock::api {

/// The section of this title: `[rock]`, `[[stage]]`, empty for the keys outside all tables; null where there is none.
const scenario::SectionReference* section_of(std::string_view title);

/// Names of the tables of a scenario, and of the lists of them.
std::vector<std::string> table_names();

/// As Scenario::known_keys.
std::vector<KeyMeaning> known_keys(const std::string& table);

/// Whether the program knows a [[list]] of this name.
bool is_list_section(const std::string& key);

}  // namespace keyblock::api
