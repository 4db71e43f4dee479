#pragma once
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

#include "record/record.h"
#include "record/row_fields.h"

/// The members of records that are written in several places, once, with their names.
namespace keyblock::record {

/// A term of the balance of energies, in the order of every table.
struct EnergyField {
  const char* name;
  double Energy::*number;
  const char* unit = "J/m";
  bool is_late = false;  ///< results of earlier versions do not have it
};
inline constexpr EnergyField energy_fields[] = {{"kinetic", &Energy::kinetic},
                                                {"strain", &Energy::strain},
                                                {"gravity", &Energy::gravity},
                                                {"contact", &Energy::contact},
                                                {"friction", &Energy::friction},
                                                {"damping", &Energy::damping},
                                                {"input", &Energy::input},
                                                {"numerical", &Energy::numerical},
                                                {"residual_ratio", &Energy::residual_ratio, "1"},
                                                {"radiated", &Energy::radiated, "J/m", true},
                                                {"water", &Energy::water, "J/m", true}};
static_assert(sizeof(Energy) == std::size(energy_fields) * sizeof(double), "a term of the energy is missing");

/// Quantities of a history point with their units, in the order of every table.
struct HistoryField {
  const char* name;
  const char* unit;
  double HistoryRow::Point::*member;
};
inline constexpr HistoryField history_fields[] = {
    {"ux", "m", &HistoryRow::Point::ux},    {"uy", "m", &HistoryRow::Point::uy},
    {"vx", "m/s", &HistoryRow::Point::vx},  {"vy", "m/s", &HistoryRow::Point::vy},
    {"sxx", "Pa", &HistoryRow::Point::sxx}, {"syy", "Pa", &HistoryRow::Point::syy},
    {"sxy", "Pa", &HistoryRow::Point::sxy}, {"ax", "m/s2", &HistoryRow::Point::ax},
    {"ay", "m/s2", &HistoryRow::Point::ay}};  // results of earlier versions have no ax, ay
static_assert(sizeof(HistoryRow::Point) == std::size(history_fields) * sizeof(double),
              "a quantity of histories is missing");

/// How the steps went, but for the energies, in the order of every table.
inline constexpr std::tuple step_fields{
    RowField{"time", "s", "simulated time", &StepRow::time},
    RowField{"stage", "1", "stage, from 0", &StepRow::stage},
    RowField{"step", "1", "step of the run", &StepRow::step},
    RowField{"iterations", "1", "open-close iterations", &StepRow::iterations},
    RowField{"step_size", "s", "smallest part of the step; static: pseudo time step", &StepRow::step_size},
    RowField{"penetration", "m", "largest depth that the contact code sees", &StepRow::penetration},
    RowField{"max_displacement", "m", "largest of the step", &StepRow::max_displacement},
    RowField{"closed_contacts", "1", "contacts closed in the end", &StepRow::closed_contacts}};

/// Names of energy_fields.
inline std::vector<std::string> energy_names() {
  std::vector<std::string> names;
  for (const EnergyField& field : energy_fields) names.emplace_back(field.name);
  return names;
}

/// Names of history_fields.
inline std::vector<std::string> history_quantities() {
  std::vector<std::string> names;
  for (const HistoryField& field : history_fields) names.emplace_back(field.name);
  return names;
}

}  // namespace keyblock::record
