#pragma once
#include <memory>
#include <optional>

#include "coupling/coupling.h"
#include "model/model.h"
#include "model/state.h"
#include "record/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// The water of a run, or nothing where there is none.
std::shared_ptr<const dynamics::Coupling> joint_water(const RunSetup& setup, const dynamics::Model& model);

/// What the water does where blocks are; nothing where none acts.
std::optional<record::WaterRecord> water_record(const dynamics::Model& model, const dynamics::State& state);

/// Which of the waters acts in stage k, by its index: that of the stage, else of the last one before it that chose, else the first. −1: none.
int water_in(const RunSetup& setup, std::size_t k);

}  // namespace keyblock::simulation
