#pragma once
#include <string>
#include <vector>

#include "core/error.h"
#include "loading/ground_motion.h"
#include "scenario/scenario.h"

/// A stage takes whole steps.
namespace keyblock::scenario {

/// Dynamic stages of less than one step, or of more than any run takes; `motions` are those of the scenario.
std::vector<Diagnostic> stage_mistakes(const Scenario& scenario,
                                       const std::vector<loading::GroundMotion>& motions);

/// Stages that last longer or shorter than their `duration`, which is no multiple of the step.
void add_stage_warnings(const Scenario& scenario, std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
