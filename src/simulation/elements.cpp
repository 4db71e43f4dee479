#include "simulation/elements.h"

#include <cmath>

#include "core/index.h"
#include "coupling/coupling.h"

namespace keyblock::simulation {

using dynamics::Carried;
using dynamics::Model;
using dynamics::State;

namespace {

/// Calls of(coupling, carried) for each coupling.
template <typename Of>
void for_carried(const Model& model, const State& state, const Of& of) {
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const dynamics::Coupling& coupling = *model.couplings[k];
    // There is no memory before the first step.
    const std::vector<double> none(k < state.couplings.size() ? 0 : coupling.memory_size(), 0.0);
    of(coupling, coupling.carried(model, state, k < state.couplings.size() ? state.couplings[k] : none));
  }
}

}  // namespace

std::size_t element_count(const Model& model) {
  std::size_t count = 0;
  for (const auto& coupling : model.couplings) count += coupling->elements().size();
  return count;
}

void keep_peaks(const Model& model, const State& state, int stage, std::vector<ElementPeak>& peaks) {
  std::size_t k = 0;
  for_carried(model, state, [&](const auto& /*coupling*/, const std::vector<Carried>& carried) {
    if (peaks.size() < k + carried.size()) peaks.resize(k + carried.size());
    for (const Carried& one : carried) {
      ElementPeak& peak = peaks[k++];
      if (std::abs(one.force) > peak.force) peak = {std::abs(one.force), state.time, stage};
    }
  });
}

std::vector<ElementRecord> element_records(const Model& model, const State& state,
                                           const std::vector<ElementPeak>& peaks,
                                           const std::vector<Stage>& stages) {
  std::vector<ElementRecord> records;
  for_carried(model, state, [&](const dynamics::Coupling& coupling, const std::vector<Carried>& carried) {
    const std::vector<dynamics::Element> elements = coupling.elements();
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const Carried& now = carried[i];
      const ElementPeak peak = records.size() < peaks.size() ? peaks[records.size()] : ElementPeak{};
      records.push_back(
          {.name = elements[i].name,
           .kind = elements[i].kind,
           .peak_stage = peak.stage < 0 ? "" : stages[static_cast<std::size_t>(peak.stage)].name,
           .present = now.present,
           .from = now.from,
           .to = now.to,
           .force = now.force,
           .elongation = now.elongation,
           .yielded = now.yielded,
           .peak_force = peak.force,
           .peak_time = peak.time,
           .limit = elements[i].limit});
    }
  });
  return records;
}

}  // namespace keyblock::simulation
