#pragma once
#include <optional>
#include <string>

#include "record/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// When the last of all loads, prescribed displacements and pressures over time becomes constant.
struct PlannedChange {
  double time = 0.0;  ///< s, simulated
  std::string what;   ///< "load 1"
};
/// None: nothing changes over time.
[[nodiscard]] std::optional<PlannedChange> last_planned_change(const RunSetup& setup);

/// What a stage that ends when all is still waits for: the last planned change, or the end of its shaking if that is later. Its start and
/// planned duration are known. What comes only after its longest duration is waited for as well: stages after it count on its time.
[[nodiscard]] std::optional<record::StageWait> wait_of(const RunSetup& setup,
                                                       const record::StageRecord& record);

}  // namespace keyblock::simulation
