#include "simulation/install.h"

#include <algorithm>

#include "coupling/coupling.h"
#include "coupling/facets.h"

namespace keyblock::simulation {

void install(const RunSetup& setup, const record::Stage& stage, const dynamics::Model& model,
             dynamics::State& state) {
  if (stage.install.empty()) return;
  std::vector<std::uint8_t> now(setup.staged_supports.size(), 0);
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (std::ranges::find(stage.install, setup.staged_supports[k]) != stage.install.end())
      now[k] = state.installed[k] = 1;
  }
  for (std::size_t c = 0; c < model.couplings.size(); ++c) {
    if (const dynamics::StagedSupports* supports = model.couplings[c]->staged_supports())
      supports->install(model, state, now, state.couplings[c]);
  }
}

}  // namespace keyblock::simulation
