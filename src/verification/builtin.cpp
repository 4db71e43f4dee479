#include "verification/builtin.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace keyblock::verification {
namespace {

using Check = BuiltinResults (*)(const std::vector<std::filesystem::path>&);

constexpr std::pair<const char*, Check> checks[] = {
    {"polygon_integrals", polygon_integrals},
    {"cutting_of_chords", cutting_of_chords},
    {"trace_statistics", trace_statistics},
    {"trace_topology", trace_topology},
};

}  // namespace

std::vector<std::string> builtin_names() {
  std::vector<std::string> names;
  for (const auto& check : checks) names.emplace_back(check.first);
  return names;
}

bool is_builtin(const std::string& name) {
  const auto names = builtin_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

BuiltinResults run_builtin(const std::string& name, const std::vector<std::filesystem::path>& data) {
  for (const auto& check : checks) {
    if (name == check.first) return check.second(data);
  }
  throw std::invalid_argument("no built-in check '" + name + "'");
}

}  // namespace keyblock::verification
