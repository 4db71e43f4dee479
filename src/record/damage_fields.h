#pragma once
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"

/// The measures of damage, each described once: files, studies, limits and pages read these tables.
namespace keyblock::record {

/// The unit in which people are shown a measure: numbers are multiplied by the factor.
struct ShownUnit {
  const char* unit;
  double factor = 1.0;
};

/// Tables of the report of a run, one after the other.
enum class DamageTable { none, rock, joints, elements };

/// A column of them.
struct DamageColumn {
  DamageTable table = DamageTable::none;
  const char* title = "";
  int decimals = 0;  ///< at least so many
};

template <class Number>
struct DamageField {
  const char* name;   ///< in files
  const char* title;  ///< in studies
  const char* unit;  ///< SI, angles in degrees; of sections, per metre of tunnel; empty for counts and shares
  Number Damage::*number;
  ShownUnit shown;
  DamageColumn column;
  const char* known_with =
      nullptr;  ///< of a count: the measure which is not a number where the count is not known
};

inline constexpr DamageField<int> damage_counts[] = {
    {"fallen_blocks",
     "fallen blocks",
     "",
     &Damage::fallen_blocks,
     {""},
     {DamageTable::rock, "Fallen blocks"},
     "fallen_area_m2"},
    {"hinges", "hinges", "", &Damage::hinges, {""}, {DamageTable::joints, "Hinges"}, "rotation_max_deg"},
    {"yielded_elements",
     "elements that have reached their limit",
     "",
     &Damage::yielded_elements,
     {""},
     {DamageTable::elements, "Have reached their limit"},
     "largest_utilization"},
    {"ruptured_elements",
     "elements that have broken",
     "",
     &Damage::ruptured_elements,
     {""},
     {DamageTable::elements, "Have broken"},
     "largest_utilization"}};

inline constexpr ShownUnit in_millimetres{"mm", 1e3}, in_kilonewtons{"kN/m", 1e-3},
    in_kilopascals{"kPa", 1e-3}, in_percent{"%", 100.0}, in_metres{"m"}, in_square_metres{"m²"};

inline constexpr DamageField<double> damage_fields[] = {
    {"fallen_area_m2",
     "fallen area",
     "m²",
     &Damage::fallen_area,
     in_square_metres,
     {DamageTable::rock, "Fallen area", 2}},
    {"fallen_weight_n_m",
     "weight of fallen rock",
     "N/m",
     &Damage::fallen_weight,
     in_kilonewtons,
     {DamageTable::rock, "Fallen weight", 1}},
    {"largest_block_pressure_pa",
     "weight of the largest fallen block over its width",
     "Pa",
     &Damage::largest_block_pressure,
     in_kilopascals,
     {DamageTable::rock, "Largest block over its width", 1}},
    {"largest_fallen_area_m2",
     "area of the largest fallen block",
     "m²",
     &Damage::largest_fallen_area,
     in_square_metres,
     {}},
    {"largest_fallen_weight_n_m",
     "weight of the largest fallen block",
     "N/m",
     &Damage::largest_fallen_weight,
     in_kilonewtons,
     {DamageTable::rock, "Largest block", 1}},
    {"fallen_depth_m", "depth of fallen rock behind the wall", "m", &Damage::fallen_depth, in_metres, {}},
    {"fallen_depth_crown_m",
     "depth of fallen rock behind the crown",
     "m",
     &Damage::fallen_depth_crown,
     in_metres,
     {DamageTable::rock, "Depth, crown", 2}},
    {"fallen_depth_left_m",
     "depth of fallen rock behind the left wall",
     "m",
     &Damage::fallen_depth_left,
     in_metres,
     {DamageTable::rock, "Depth, left wall", 2}},
    {"fallen_depth_right_m",
     "depth of fallen rock behind the right wall",
     "m",
     &Damage::fallen_depth_right,
     in_metres,
     {DamageTable::rock, "Depth, right wall", 2}},
    {"fallen_depth_invert_m",
     "depth of fallen rock behind the invert",
     "m",
     &Damage::fallen_depth_invert,
     in_metres,
     {DamageTable::rock, "Depth, invert", 2}},
    {"opening_filled_ratio",
     "filled share of the opening",
     "",
     &Damage::opening_filled_ratio,
     in_percent,
     {DamageTable::rock, "Opening filled", 1}},
    {"loosened_area_m2",
     "loosened area",
     "m²",
     &Damage::loosened_area,
     in_square_metres,
     {DamageTable::rock, "Loosened area", 2}},
    {"moving_area_m2",
     "area of blocks that move or have fallen",
     "m²",
     &Damage::moving_area,
     in_square_metres,
     {DamageTable::rock, "Moving area", 2}},
    {"displacement_max_m",
     "largest displacement",
     "m",
     &Damage::displacement_max,
     in_millimetres,
     {DamageTable::joints, "Largest displacement", 1}},
    {"stage_displacement_m",
     "largest displacement within the stage",
     "m",
     &Damage::stage_displacement,
     in_millimetres,
     {DamageTable::joints, "Within the stage", 1}},
    {"rotation_max_deg",
     "largest rotation",
     "°",
     &Damage::rotation_max,
     {"°"},
     {DamageTable::joints, "Largest rotation", 1}},
    {"slip_max_m",
     "largest slip in place",
     "m",
     &Damage::slip_max,
     in_millimetres,
     {DamageTable::joints, "Largest slip in place", 1}},
    {"slip_max_ever_m",
     "largest slip ever",
     "m",
     &Damage::slip_max_ever,
     in_millimetres,
     {DamageTable::joints, "Largest slip ever", 1}},
    {"slip_mean_m",
     "mean slip in place",
     "m",
     &Damage::slip_mean,
     in_millimetres,
     {DamageTable::joints, "Mean slip in place", 2}},
    {"slipped_length_m", "slipped length in place", "m", &Damage::slipped_length, in_metres, {}},
    {"slipped_length_ever_m",
     "slipped length ever",
     "m",
     &Damage::slipped_length_ever,
     in_metres,
     {DamageTable::joints, "Slipped ever", 1}},
    {"opening_max_m",
     "largest opening in place",
     "m",
     &Damage::opening_max,
     in_millimetres,
     {DamageTable::joints, "Largest opening in place", 1}},
    {"opening_max_ever_m",
     "largest opening ever",
     "m",
     &Damage::opening_max_ever,
     in_millimetres,
     {DamageTable::joints, "Largest opening ever", 1}},
    {"opened_length_m", "opened length in place", "m", &Damage::opened_length, in_metres, {}},
    {"opened_length_ever_m",
     "opened length ever",
     "m",
     &Damage::opened_length_ever,
     in_metres,
     {DamageTable::joints, "Opened ever", 1}},
    {"closure_vertical_m",
     "vertical closure",
     "m",
     &Damage::closure_vertical,
     in_millimetres,
     {DamageTable::joints, "Closure, vertical", 2}},
    {"closure_horizontal_m",
     "horizontal closure",
     "m",
     &Damage::closure_horizontal,
     in_millimetres,
     {DamageTable::joints, "Closure, horizontal", 2}},
    {"largest_utilization",
     "largest utilization of an element",
     "",
     &Damage::largest_utilization,
     in_percent,
     {DamageTable::elements, "Largest utilization", 1}}};
static_assert(sizeof(Damage) - std::size(damage_counts) * sizeof(int) -
                      std::size(damage_fields) * sizeof(double) <
                  alignof(double),
              "a measure of the damage is missing");

/// Calls with(field) for each measure, counts first.
template <class With>
void for_damage_fields(const With& with) {
  for (const auto& field : damage_counts) with(field);
  for (const auto& field : damage_fields) with(field);
}

/// All names, counts first.
inline std::vector<std::string> damage_names() {
  std::vector<std::string> names;
  for_damage_fields([&](const auto& field) { names.emplace_back(field.name); });
  return names;
}

/// The measure of this name. Throws std::invalid_argument where there is none.
inline double damage_value(const Damage& damage, std::string_view measure) {
  double value = 0.0;
  bool found = false;
  for_damage_fields([&](const auto& field) {
    if (measure != field.name) return;
    value = damage.*field.number;
    found = true;
  });
  if (!found) throw std::invalid_argument("no measure of damage '" + std::string(measure) + "'");
  return value;
}

}  // namespace keyblock::record
