#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "simulation/element_record.h"
#include "simulation/stage.h"

/// What the elements of a model carry, springs and supports, and have carried at the most (dynamics::Element).
namespace keyblock::simulation {

/// The largest force that an element has carried in a run; its memory, which a checkpoint has.
struct ElementPeak {
  double force = 0.0;       ///< N per thickness, its size
  double time = 0.0;        ///< s
  std::int64_t stage = -1;  ///< −1: it has carried nothing
};

/// After a step of a stage.
void keep_peaks(const dynamics::Model& model, const dynamics::State& state, int stage,
                std::vector<ElementPeak>& peaks);
/// All elements of a model, in the order of its couplings. stages: of the run.
std::vector<ElementRecord> element_records(const dynamics::Model& model, const dynamics::State& state,
                                           const std::vector<ElementPeak>& peaks,
                                           const std::vector<Stage>& stages);
std::size_t element_count(const dynamics::Model& model);

}  // namespace keyblock::simulation
