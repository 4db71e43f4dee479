#include "job/check.h"

#include "scenario/inputs.h"
#include "simulation/build_model.h"
#include "simulation/feasibility.h"

namespace keyblock::job {

std::vector<std::string> check(const scenario::Scenario& scenario, const scenario::BlockModel& blocks,
                               int realization) {
  std::vector<std::string> warnings;
  if (scenario.stages.empty()) {
    warnings = scenario::check_inputs(scenario);
    scenario::add_block_warnings(scenario, blocks, warnings);
    scenario::add_overlap_warnings(scenario, blocks.system, warnings);
    return warnings;
  }
  const simulation::RunSetup setup = scenario::build_setup(scenario, realization, blocks, &warnings);
  simulation::build_model(setup);
  if (const auto reason = simulation::yields_without_limit(setup))
    warnings.push_back("a run ends at once: " + *reason);
  return warnings;
}

}  // namespace keyblock::job
