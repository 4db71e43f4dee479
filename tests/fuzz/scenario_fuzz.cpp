#include "rockmass/trace_generator.h"
#include "scenario/build.h"
#include "scenario/inputs.h"
#include "scenario/parse.h"
#include "try.h"

namespace keyblock::fuzz {
namespace {

/// Whether blocks are cut in a moment.
bool is_small(const scenario::Scenario& scenario) {
  constexpr double most_traces = 200.0;
  if (!scenario.domain) return true;
  double traces = 0.0;
  for (const scenario::JointSetSpec& spec : scenario.joint_sets)
    traces += rockmass::expected_traces(spec.set, *scenario.section_azimuth, scenario.domain->box());
  return traces < most_traces;
}

}  // namespace

void try_bytes(std::string_view bytes) {
  // Files that a scenario names are looked for where there are none.
  const scenario::Scenario scenario = scenario::parse_scenario_text(bytes, "/nowhere/fuzz.toml");
  static_cast<void>(scenario::plausibility_warnings(scenario));
  if (is_small(scenario)) static_cast<void>(scenario::build_blocks(scenario, 0));
}

}  // namespace keyblock::fuzz
