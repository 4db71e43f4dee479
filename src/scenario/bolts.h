#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/polygon.h"
#include "scenario/scenario.h"
#include "simulation/setup.h"

/// Rock bolts of a scenario.
namespace keyblock::scenario {

/// The straight sides of an outline within an arc, in degrees about its centroid, or all: counter-clockwise from the start of the arc.
std::vector<std::pair<Vec2, Vec2>> sides_of(const std::optional<std::pair<double, double>>& arc,
                                            const Ring& outline);

/// Head and toe of the bolts of a pattern, counter-clockwise along an outline, which is so: evenly, first and last at the ends of the arc;
/// outwards, normal to the outline, at a corner between the normals of its edges.
std::vector<std::pair<Vec2, Vec2>> pattern_of(const BoltSpec& spec, const Ring& outline);

/// Every bolt of the scenario. outlines: of the excavations. Coordinates are those of the outlines and the scenario.
std::vector<loading::Bolt> bolts_of(const Scenario& scenario, const std::vector<Ring>& outlines);

/// Throws what only the cut blocks show to be wrong, with the place in the scenario: ends in no rock, pretension that a bolt cannot have. Adds what seems odd.
void check_bolts(const Scenario& scenario, const simulation::RunSetup& setup,
                 std::vector<std::string>& warnings);

}  // namespace keyblock::scenario
