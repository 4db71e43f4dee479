#pragma once
#include <string>
#include <vector>

#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario_text.h"

namespace keyblock::scenario {

/// Of the setup of a scenario.
inline std::vector<std::string> warnings_of(const std::string& text,
                                            const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> warnings;
  build_setup(parse(text, overrides), 0, &warnings);
  return warnings;
}

}  // namespace keyblock::scenario
