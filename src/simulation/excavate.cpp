#include "simulation/excavate.h"

#include <algorithm>

#include "simulation/energy_audit.h"

namespace keyblock::simulation {

void excavate(const RunSetup& setup, const record::Stage& stage, dynamics::Model& model,
              dynamics::State& state, dynamics::Stepper& stepper, DamageGauge& gauge,
              const StagedOpening& opening) {
  if (stage.excavate.empty()) return;
  opening.keep_forces(stage, state, stepper);
  const double before = stored_energy(model, state);
  gauge.open(stage.excavate, state);
  const auto is_opened = [&](int excavation) {
    return std::find(stage.excavate.begin(), stage.excavate.end(), excavation) != stage.excavate.end();
  };
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    const auto& inside = setup.system.blocks[b].excavations;
    if (std::any_of(inside.begin(), inside.end(), is_opened)) model.surface.present[b] = 0;
  }
  if (!gauge.started()) gauge.start(state, stepper.find_contacts(state));
  stepper.remove_absent(state);
  state.ledger.input += stored_energy(model, state) - before;
}

}  // namespace keyblock::simulation
