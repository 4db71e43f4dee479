#include "simulation/planned_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulation/stillness.h"

namespace keyblock::simulation {

std::optional<PlannedChange> last_planned_change(const RunSetup& setup) {
  std::optional<PlannedChange> last;
  const auto add = [&](const loading::TimeTable& table, const auto& name) {
    const auto time = table.last_change();
    if (time && (!last || *time > last->time)) last = {*time, name()};
  };
  for (std::size_t k = 0; k < setup.loads.size(); ++k)
    add(setup.loads[k].factor, [&] { return fmt::format("load {}", k + 1); });
  for (std::size_t k = 0; k < setup.supports.size(); ++k) {
    const auto name = [&] { return fmt::format("the prescribed displacement of support {}", k + 1); };
    add(setup.supports[k].motion_x, name);
    add(setup.supports[k].motion_y, name);
  }
  for (const BlockProperties& block : setup.properties) {
    const auto name = [&] {
      return block.name.empty() ? std::string("the motion of a fixed block")
                                : fmt::format("the motion of the fixed block '{}'", block.name);
    };
    add(block.motion_x, name);
    add(block.motion_y, name);
  }
  for (const Excavation& opening : setup.excavations)
    add(opening.pressure.over_time, [&] { return fmt::format("the pressure in '{}'", opening.name); });
  return last;
}

std::optional<record::StageWait> wait_of(const RunSetup& setup, const record::StageRecord& record) {
  const record::Stage& stage = record.stage;
  if (!stage.until_still) return std::nullopt;
  const double duration = record.planned_duration.value_or(0.0);
  std::optional<record::StageWait> wait;
  if (const auto change = last_planned_change(setup); change && change->time > record.start_time)
    wait = {std::min(change->time - record.start_time, duration), change->what};
  if (stage.kind != record::StageKind::shake || stage.scale == 0.0) return wait;
  const double shaking = end_of_shaking(setup.motions.at(static_cast<std::size_t>(stage.motion)), duration,
                                        stage.still_acceleration / std::abs(stage.scale));
  if (shaking > 0.0 && (!wait || shaking > wait->until)) wait = {shaking, "the shaking"};
  return wait;
}

}  // namespace keyblock::simulation
