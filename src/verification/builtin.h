#pragma once
#include <map>
#include <string>
#include <vector>

namespace keyblock::verification {

/// Figures of a check, by name: what result('…') of its quantities reads.
using BuiltinResults = std::map<std::string, double, std::less<>>;

/// Checks that have no scenario: of exact integrals, of cutting of random lines, of statistics of joints before they are clipped,
/// of traces that were mapped.
std::vector<std::string> builtin_names();
bool is_builtin(const std::string& name);
/// Precondition: is_builtin(name).
BuiltinResults run_builtin(const std::string& name);

BuiltinResults polygon_integrals();

}  // namespace keyblock::verification
