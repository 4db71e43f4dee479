#pragma once
#include <string>
#include <vector>

#include "loading/ground_motion.h"
#include "scenario/ground_facts.h"
#include "scenario/scenario.h"

namespace keyblock::scenario {

/// What seems wrong with the shaking of a scenario's stages, added to `warnings`: a time step that is long for the motion, a peak
/// that no earthquake has, a scale that seems to be a peak, a window without the strong part, damping by which it does not swing. `motions` are those of the scenario, read.
void add_shaking_warnings(const Scenario& scenario, const std::vector<loading::GroundMotion>& motions,
                          std::vector<std::string>& warnings);

/// The earthquake of each stage that shakes: "0.27 g horizontal in the section, 94 % of the Arias intensity in the window".
std::vector<GroundFact> earthquake_facts(const Scenario& scenario,
                                         const std::vector<loading::GroundMotion>& motions);

/// The shaking stage whose scale a key path leads to, `stage.shaken.scale`, or null.
const record::Stage* stage_of_scale(const Scenario& scenario, const std::string& key);

/// Scales in a study that seem to be peaks, or per cents.
void add_study_scale_warnings(const Scenario& scenario, const std::vector<loading::GroundMotion>& motions,
                              std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
