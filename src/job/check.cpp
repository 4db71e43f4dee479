#include "job/check.h"

#include <fmt/format.h>

#include <utility>

#include "scenario/far_rock.h"
#include "scenario/inputs.h"
#include "scenario/joint_table.h"
#include "scenario/joint_warnings.h"
#include "simulation/build_model.h"
#include "simulation/feasibility.h"

namespace keyblock::job {

Checked check(const scenario::Scenario& scenario, int realization) {
  std::vector<std::string> of_inputs = scenario::check_inputs(scenario);
  Checked checked{scenario::build_blocks(scenario, realization), {}, {}};
  if (scenario.stages.empty()) {
    checked.warnings = std::move(of_inputs);
    scenario::add_block_warnings(scenario, checked.blocks, checked.warnings);
    scenario::add_overlap_warnings(scenario, checked.blocks.system, checked.warnings);
  } else {
    // Has those of the inputs as well.
    const simulation::RunSetup setup =
        scenario::build_setup(scenario, realization, checked.blocks, &checked.warnings);
    simulation::build_model(setup);
    for (const auto& [name, value] : setup.ground) {
      const bool is_turned = name == "gravity" && value.find("downwards") != std::string::npos;
      if (name == "boundary" || is_turned || name.starts_with("earthquake") || name.starts_with("water"))
        checked.notes.push_back(fmt::format("{}: {}", name, value));
    }
    for (const auto& [name, value] : scenario::boundary_facts(setup))
      checked.notes.push_back(fmt::format("{}: {}", name, value));
    for (const auto& [name, value] : scenario::strength_facts(setup.joints))
      checked.notes.push_back(fmt::format("{}: {}", name, value));
    if (const auto reason = simulation::yields_without_limit(setup))
      checked.warnings.push_back("a run ends at once: " + *reason);
  }
  if (const std::string joints = scenario::joints_in_model(scenario, checked.blocks.system); !joints.empty())
    checked.notes.push_back("joints in the model, of their length: " + joints);
  for (std::string& warning : scenario::study_warnings(scenario))
    checked.warnings.push_back(std::move(warning));
  return checked;
}

}  // namespace keyblock::job
