#include "scenario/magnitudes.h"

#include <fmt/format.h>

namespace keyblock::scenario {

std::string place_text(const SourcePosition& where) {
  return where.line > 0 ? fmt::format(" (line {})", where.line) : " (--set)";
}

std::string place_text(const Scenario& scenario, const std::string& key) {
  const auto found = scenario.positions.find(key);
  return found == scenario.positions.end() ? std::string() : place_text(found->second);
}

void add_magnitude_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  if (scenario.si_units) warnings.insert(warnings.end(), scenario.unusual.begin(), scenario.unusual.end());
}

}  // namespace keyblock::scenario
