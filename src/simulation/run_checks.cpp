#include "simulation/run_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace keyblock::simulation {

namespace {

constexpr long most_unconverged = 100;  // steps in a row

[[noreturn]] void give_up(const RunSetup& setup, const std::string& reason) {
  std::string text = reason + "; the results up to there are kept";
  for (const std::string& warning : setup.warnings) text += "; odd input: " + warning;
  throw RunError(text);
}

const std::string& stage_name(const RunSetup& setup, const RunState& now) {
  return setup.stages[static_cast<std::size_t>(now.stage)].name;
}

}  // namespace

void check_energies(const RunSetup& setup, const RunState& now, const record::Energy& energy) {
  if (std::isfinite(energy.residual_ratio)) return;
  give_up(setup, fmt::format("the energies after step {} of stage '{}' are no finite numbers", now.stage_step,
                             stage_name(setup, now)));
}

void check_state(const RunSetup& setup, const RunState& now) {
  const std::vector<double>& x = now.mechanics.position;
  if (std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); })) return;
  give_up(setup,
          fmt::format("step {} of stage '{}' left no finite state", now.stage_step, stage_name(setup, now)));
}

void check_converging(const RunSetup& setup, const RunState& now) {
  if (now.mechanics.step - now.record.open_close.last_converged_step < most_unconverged) return;
  give_up(setup, fmt::format("{} steps in a row did not converge, the last of them step {} of stage '{}'",
                             most_unconverged, now.stage_step, stage_name(setup, now)));
}

void check_solved(const RunSetup& setup, const RunState& now, const record::StageRecord& stage) {
  const long before = now.mechanics.step - stage.steps;
  if (stage.steps == 0 || now.record.open_close.last_converged_step > before) return;
  give_up(setup, fmt::format("no step of stage '{}' converged, of {} from step {} of the run on",
                             stage.stage.name, stage.steps, before + 1));
}

}  // namespace keyblock::simulation
