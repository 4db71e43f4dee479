#include "scenario/stage_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/key_path.h"
#include "simulation/step_count.h"

namespace keyblock::scenario {
namespace {

// Steps of a stage beyond which it is refused.
constexpr double most_stage_steps = 1e9;
// A duration that differs from whole steps by more than this share of a step is worth a warning.
constexpr double whole_step_tolerance = 1e-6;

}  // namespace

std::vector<Diagnostic> stage_mistakes(const Scenario& scenario,
                                       const std::vector<loading::GroundMotion>& motions) {
  std::vector<Diagnostic> mistakes;
  for (const record::Stage& stage : scenario.stages) {
    if (stage.kind == record::StageKind::settle) continue;
    const double duration =
        stage.duration ? *stage.duration : motions[static_cast<std::size_t>(stage.motion)].duration();
    const double steps = duration / scenario.time_step;
    if (steps >= 1.0 - whole_step_tolerance && steps <= most_stage_steps) continue;
    const std::string path = join_path("stage", stage.name);
    const std::string key = stage.duration ? join_path(path, "duration") : path;
    mistakes.push_back({scenario.where(key), key,
                        fmt::format("{} s{}, {:.3g} steps of {} s", duration,
                                    stage.duration ? "" : " of motion", steps, scenario.time_step),
                        fmt::format("1 to {:.0e} steps", most_stage_steps), ""});
  }
  return mistakes;
}

void add_stage_warnings(const Scenario& scenario, std::vector<std::string>& warnings) {
  for (const record::Stage& stage : scenario.stages) {
    if (!stage.duration) continue;
    const double steps = *stage.duration / scenario.time_step;
    const double whole = simulation::step_count(*stage.duration, scenario.time_step);
    if (std::abs(steps - whole) <= whole_step_tolerance * std::max(1.0, whole)) continue;
    warnings.push_back(
        fmt::format("{}: {} s is no multiple of the time step {} s; the stage takes {} step{}, {:.6g} s",
                    join_path(join_path("stage", stage.name), "duration"), *stage.duration,
                    scenario.time_step, whole, whole == 1.0 ? "" : "s", whole * scenario.time_step));
  }
}

}  // namespace keyblock::scenario
