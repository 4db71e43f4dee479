#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "census/census.h"
#include "scenario/build.h"

/// The census of key blocks of a scenario: docs/guide/limits.md, "Key blocks".
namespace keyblock::scenario {

constexpr double usual_wanted_factor = 1.5;

/// What a census supposes, in one sentence for people.
extern const char* const census_assumptions;

/// k_h and k_v of the last static stage that has any.
Vec2 seismic_coefficients(const Scenario& scenario);

/// The key blocks of a realization, with all excavations open and peak strengths of joints. The edge of the domain is rock that stays, with the
/// friction of the frame, but free where `boundary = "free"` or [boundary] top = "free" say so. Throws InputError where no rock has a free face,
/// and without gravity.
census::Census take_census(const Scenario& scenario, const BlockModel& model, double wanted_factor);

/// What the scenario has and a census leaves out.
std::vector<std::string> census_notes(const Scenario& scenario);

/// The sets and maps along which a block slides; "[joints]" where it is along an edge of an explicit block.
std::vector<std::string> sliding_joints(const Scenario& scenario, const census::KeyBlock& block);
/// Name of an explicit block; empty for others.
std::string block_name(const Scenario& scenario, const BlockModel& model, int block);

/// census.json of one realization, documented in the guide.
nlohmann::ordered_json census_json(const Scenario& scenario, int realization, const BlockModel& model,
                                   const census::Census& census, double wanted_factor);

}  // namespace keyblock::scenario
