#pragma once
#include <iterator>
#include <utility>

#include "simulation/record.h"

/// The members of records that are written in several places, once, with their names.
namespace keyblock::results {

inline constexpr std::pair<const char*, double simulation::Energy::*> energy_fields[] = {
    {"kinetic", &simulation::Energy::kinetic},
    {"strain", &simulation::Energy::strain},
    {"gravity", &simulation::Energy::gravity},
    {"contact", &simulation::Energy::contact},
    {"friction", &simulation::Energy::friction},
    {"damping", &simulation::Energy::damping},
    {"input", &simulation::Energy::input},
    {"numerical", &simulation::Energy::numerical},
    {"residual_ratio", &simulation::Energy::residual_ratio}};
static_assert(sizeof(simulation::Energy) == std::size(energy_fields) * sizeof(double),
              "a term of the energy is missing");

/// In SI units; `fallen_blocks` stands beside them.
inline constexpr std::pair<const char*, double simulation::Damage::*> damage_fields[] = {
    {"fallen_area_m2", &simulation::Damage::fallen_area},
    {"opening_filled_ratio", &simulation::Damage::opening_filled_ratio},
    {"loosened_area_m2", &simulation::Damage::loosened_area},
    {"slip_max_m", &simulation::Damage::slip_max},
    {"slip_mean_m", &simulation::Damage::slip_mean},
    {"slipped_length_m", &simulation::Damage::slipped_length},
    {"opened_length_m", &simulation::Damage::opened_length},
    {"closure_vertical_m", &simulation::Damage::closure_vertical},
    {"closure_horizontal_m", &simulation::Damage::closure_horizontal}};
// The count of fallen blocks takes the room of one more.
static_assert(sizeof(simulation::Damage) == (1 + std::size(damage_fields)) * sizeof(double),
              "a measure of the damage is missing");

}  // namespace keyblock::results
