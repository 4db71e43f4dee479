#pragma once
#include <string>
#include <vector>

#include "keyblock/scenario.h"

namespace keyblock::api {

/// As Scenario::known_keys.
std::vector<KeyMeaning> known_keys(const std::string& table);

/// Whether the program knows a [[list]] of this name.
bool is_list_section(const std::string& key);

}  // namespace keyblock::api
