#include "scenario/magnitudes.h"

#include <fmt/format.h>

#include <algorithm>

#include "scenario/load_checks.h"

namespace keyblock::scenario {

std::string place_text(const SourcePosition& where) {
  return where.line > 0 ? fmt::format(" (line {})", where.line) : " (--set)";
}

std::string place_text(const Scenario& scenario, const std::string& key) {
  const auto found = scenario.positions.find(key);
  return found == scenario.positions.end() ? std::string() : place_text(found->second);
}

void add_magnitude_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  if (!scenario.si_units) return;
  for (const UnusualValue& value : scenario.unusual)
    if (!is_weak_load(scenario, value.key)) warnings.push_back(value.text);
}

bool is_unusual(const Scenario& scenario, const std::string& key) {
  return scenario.si_units && std::ranges::any_of(scenario.unusual, [&](const UnusualValue& value) {
           return value.key.starts_with(key) &&
                  (value.key.size() == key.size() || value.key[key.size()] == '.' ||
                   value.key[key.size()] == '[');
         });
}

}  // namespace keyblock::scenario
