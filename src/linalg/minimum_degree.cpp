#include "linalg/minimum_degree.h"

#include <amd.h>

#include <stdexcept>

#include "core/index.h"

namespace keyblock::linalg {

EliminationOrder approximate_minimum_degree(int n, std::span<const std::pair<int, int>> pairs) {
  std::vector<int> start(at(n) + 1, 0), neighbour(2 * pairs.size() + 1);
  for (const auto& [i, j] : pairs) {
    ++start[at(i) + 1];
    ++start[at(j) + 1];
  }
  for (std::size_t k = 0; k < at(n); ++k) start[k + 1] += start[k];
  std::vector<int> next(start.begin(), start.end() - 1);
  for (const auto& [i, j] : pairs) {
    neighbour[at(next[static_cast<std::size_t>(i)]++)] = j;
    neighbour[at(next[static_cast<std::size_t>(j)]++)] = i;
  }
  EliminationOrder found;
  found.order.resize(at(n));
  double control[AMD_CONTROL], info[AMD_INFO];
  amd_defaults(control);
  if (n > 0 && amd_order(n, start.data(), neighbour.data(), found.order.data(), control, info) < 0) {
    throw std::logic_error("amd_order refused the pattern");
  }
  if (n > 0) found.products = info[AMD_NMULTSUBS_LDL];
  return found;
}

}  // namespace keyblock::linalg
