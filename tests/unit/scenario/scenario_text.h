#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "scenario/build.h"
#include "scenario/parse.h"

namespace keyblock::scenario {

inline const std::filesystem::path examples = std::filesystem::path(KEYBLOCK_SOURCE_DIR) / "examples";

/// A scenario that is right: two blocks, one of them fixed, and one stage.
inline const std::string two_blocks = R"([rock]
density = 2600.0
young = 1e9
poisson = 0.2

[joints]
friction = 30.0

[time]
step = 0.01

[[block]]
name = "base"
outer = [[0, 0], [4, 0], [4, 1], [0, 1]]
fixed = true

[[block]]
name = "top"
outer = [[1, 1], [3, 1], [3, 2], [1, 2]]

[[stage]]
name = "quiet"
kind = "rest"
duration = 1.0
)";

/// A scenario that is right: a domain with one joint set.
inline const std::string jointed_domain = R"(accept_warnings = ["plane-stress", "order-1", "lost-joints"]

[section]
azimuth = 90.0

[domain]
x = [0.0, 4.0]
y = [0.0, 3.0]

[rock]
density = 2600.0
young = 1e9
poisson = 0.2

[joints]
friction = 30.0

[[joint_set]]
name = "bedding"
dip = 20.0
dip_direction = 90.0
spacing = 0.5
length = 3.0
gap = 0.5
)";

inline Scenario parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scenario_text(text, std::string(KEYBLOCK_TEST_DATA) + "/scenario/test.toml", overrides);
}

/// Diagnostics of a scenario that is wrong, one per line, without the folder; empty when it is right.
inline std::string mistakes(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    parse_scenario_text(text, "test.toml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// A stage, so that the domain can be run.
inline const std::string runnable_domain = jointed_domain + R"(
[time]
step = 0.01

[[excavation]]
name = "tunnel"
shape = "circle"
center = [2.0, 1.5]
diameter = 1.0

[[stage]]
name = "settled"
kind = "settle"
excavate = ["tunnel"]
)";

/// What build_setup() has against it; empty: nothing.
inline std::string refusal(const Scenario& scenario) {
  try {
    build_setup(scenario, 0);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace keyblock::scenario
