#pragma once
#include <iterator>
#include <utility>

#include "simulation/damage_fields.h"
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
    {"residual_ratio", &simulation::Energy::residual_ratio},
    {"radiated", &simulation::Energy::radiated}};  // results of earlier versions do not have it
static_assert(sizeof(simulation::Energy) == std::size(energy_fields) * sizeof(double),
              "a term of the energy is missing");

using simulation::damage_counts;
using simulation::damage_fields;

}  // namespace keyblock::results
