#pragma once
#include <string>
#include <vector>

#include "loading/ground_motion.h"
#include "scenario/scenario.h"

namespace keyblock::scenario {

/// What seems wrong with the shaking of a scenario's stages, added to `warnings`: a time step that is long for the motion, a peak
/// that no earthquake has, damping by which it does not swing. `motions` are those of the scenario, read.
void add_shaking_warnings(const Scenario& scenario, const std::vector<loading::GroundMotion>& motions,
                          std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
