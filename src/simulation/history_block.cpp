#include "simulation/history_block.h"

#include <algorithm>

namespace keyblock::simulation {

std::optional<std::size_t> excavating_stage(const RunSetup& setup, std::size_t block) {
  const std::vector<int>& holders = setup.system.blocks[block].excavations;
  for (std::size_t s = 0; s < setup.stages.size(); ++s) {
    for (const int e : setup.stages[s].excavate) {
      if (std::find(holders.begin(), holders.end(), e) != holders.end()) return s;
    }
  }
  return std::nullopt;
}

std::optional<std::size_t> block_at(const RunSetup& setup, const std::string& name, Vec2 point) {
  std::optional<std::size_t> found;
  std::size_t found_until = 0;
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    if (!name.empty() && setup.properties[b].name != name) continue;
    if (!lies_in(setup.system.blocks[b].polygon, point)) continue;
    const std::size_t until = excavating_stage(setup, b).value_or(setup.stages.size());
    if (found && until <= found_until) continue;
    found = b;
    found_until = until;
  }
  return found;
}

}  // namespace keyblock::simulation
