#pragma once
#include <cstdint>
#include <vector>

#include "model/model.h"
#include "model/state.h"
#include "record/element_record.h"
#include "record/record.h"
#include "record/stage.h"
#include "simulation/setup.h"

/// What the elements of a model carry, springs, supports, boundaries and walls under pressure, and have carried at the most (dynamics::Element).
namespace keyblock::simulation {

/// The largest force that an element has carried in a run; its memory, which a checkpoint has.
struct ElementPeak {
  double force = 0.0;         ///< N per thickness, its size
  double time = 0.0;          ///< s
  std::int64_t stage = -1;    ///< −1: it has carried nothing
  std::int64_t ruptured = 0;  ///< 1: it has
  double utilization = 0.0;  ///< of what has limits other than a force, the largest, and what it carried then
  double worst_force = 0.0, worst_moment = 0.0, worst_shear = 0.0;
};

/// After a step of a stage. The elements that ruptured in it, but for those that go with another one.
std::vector<int> keep_peaks(const dynamics::Model& model, const dynamics::State& state, int stage,
                            std::vector<ElementPeak>& peaks);
/// All elements of a model, in the order of its couplings. stages: of the run.
std::vector<record::ElementRecord> element_records(const dynamics::Model& model, const dynamics::State& state,
                                                   const std::vector<ElementPeak>& peaks,
                                                   const std::vector<record::Stage>& stages);
/// Measures of damage that elements have.
void measure_elements(const dynamics::Model& model, const dynamics::State& state,
                      const std::vector<ElementPeak>& peaks, record::Damage& damage);
std::size_t element_count(const dynamics::Model& model);
std::vector<record::ElementDescription> element_descriptions(const dynamics::Model& model);
bool may_rupture(const dynamics::Model& model);
/// What they carry now, in the same order.
std::vector<record::ElementState> element_states(const dynamics::Model& model, const dynamics::State& state);
/// The element that a history follows, by its name. Throws InputError where there is none.
int element_of(const dynamics::Model& model, const History& history);

}  // namespace keyblock::simulation
