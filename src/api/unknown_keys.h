#pragma once
#include <string>

#include "keyblock/scenario.h"

namespace keyblock::api {

/// As Scenario::check_keys.
void check_keys(const std::string& key, const Value& value);

}  // namespace keyblock::api
