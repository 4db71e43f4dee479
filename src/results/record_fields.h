#pragma once
#include <iterator>
#include <string>
#include <utility>
#include <vector>

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
    // Results of earlier versions do not have these.
    {"radiated", &simulation::Energy::radiated},
    {"water", &simulation::Energy::water}};
static_assert(sizeof(simulation::Energy) == std::size(energy_fields) * sizeof(double),
              "a term of the energy is missing");

/// Quantities of a history point with their units, in the order of every table.
struct HistoryField {
  const char* name;
  const char* unit;
  double simulation::HistoryRow::Point::*member;
};
inline constexpr HistoryField history_fields[] = {
    {"ux", "m", &simulation::HistoryRow::Point::ux},    {"uy", "m", &simulation::HistoryRow::Point::uy},
    {"vx", "m/s", &simulation::HistoryRow::Point::vx},  {"vy", "m/s", &simulation::HistoryRow::Point::vy},
    {"sxx", "Pa", &simulation::HistoryRow::Point::sxx}, {"syy", "Pa", &simulation::HistoryRow::Point::syy},
    {"sxy", "Pa", &simulation::HistoryRow::Point::sxy}, {"ax", "m/s2", &simulation::HistoryRow::Point::ax},
    {"ay", "m/s2", &simulation::HistoryRow::Point::ay}};  // results of earlier versions have no ax, ay
static_assert(sizeof(simulation::HistoryRow::Point) == std::size(history_fields) * sizeof(double),
              "a quantity of histories is missing");

/// Names of history_fields.
inline std::vector<std::string> history_quantities() {
  std::vector<std::string> names;
  for (const HistoryField& field : history_fields) names.emplace_back(field.name);
  return names;
}

using simulation::damage_counts;
using simulation::damage_fields;

}  // namespace keyblock::results
