#include "simulation/install.h"

#include <algorithm>

#include "coupling/coupling.h"
#include "coupling/facets.h"
#include "dynamics/energy.h"

namespace keyblock::simulation {

namespace {

/// Calls of(supports, memory) for the couplings that stages install.
template <typename Of>
void for_supports(const dynamics::Model& model, dynamics::State& state, const Of& of) {
  for (std::size_t c = 0; c < model.couplings.size(); ++c) {
    if (const dynamics::StagedSupports* supports = model.couplings[c]->staged_supports())
      of(*supports, state.couplings[c]);
  }
}

}  // namespace

void install(const RunSetup& setup, const record::Stage& stage, const dynamics::Model& model,
             dynamics::State& state) {
  for_supports(model, state,
               [&](const auto& supports, auto& memory) { supports.end_stage(model, state, memory); });
  if (stage.install.empty()) return;
  const double before = dynamics::support_energy(model, state, state.time),
               kinetic = dynamics::kinetic_energy(model, state);
  std::vector<std::uint8_t> now(setup.staged_supports.size(), 0);
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (std::ranges::find(stage.install, setup.staged_supports[k]) != stage.install.end())
      now[k] = state.installed[k] = 1;
  }
  for_supports(model, state,
               [&](const auto& supports, auto& memory) { supports.install(model, state, now, memory); });
  // What pretension stores is put in.
  const double stored = dynamics::support_energy(model, state, state.time) - before;
  state.support_energy += stored;
  // So is how bodies move that are put in with them.
  state.ledger.input += stored + (dynamics::kinetic_energy(model, state) - kinetic);
}

}  // namespace keyblock::simulation
