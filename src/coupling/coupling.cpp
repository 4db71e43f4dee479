#include "coupling/coupling.h"

#include <algorithm>

#include "coupling/facets.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

int pair_in(std::span<const std::pair<int, int>> pattern, int unknown_a, int unknown_b) {
  if (unknown_a < 0 || unknown_b < 0) return Row::of_fixed;
  const std::pair<int, int> pair = std::minmax(unknown_a, unknown_b);
  const auto found = std::lower_bound(pattern.begin(), pattern.end(), pair);
  if (found == pattern.end() || *found != pair) return Row::without_room;
  return static_cast<int>(found - pattern.begin());
}

std::vector<int> held_blocks(const Model& model) {
  std::vector<int> blocks;
  for (const auto& coupling : model.couplings) coupling->add_held_blocks(blocks);
  return blocks;
}

void add_weights(const Model& model, const State& state, const Drive& drive, std::span<double> weight) {
  for (const auto& coupling : model.couplings) {
    if (const ForceScale* scale = coupling->force_scale()) scale->add_weights(model, state, drive, weight);
  }
}

WaterOfModel water_of(const Model& model, const State& state) {
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const StillWater* water = model.couplings[k]->still_water();
    if (water == nullptr) continue;
    return {water, k < state.couplings.size() ? state.couplings[k] : std::span<const double>{}};
  }
  return {};
}

}  // namespace keyblock::dynamics
