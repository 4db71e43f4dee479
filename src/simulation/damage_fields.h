#pragma once
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "simulation/record.h"

/// The measures of damage by the names that they have in files.
namespace keyblock::simulation {

inline constexpr std::pair<const char*, int Damage::*> damage_counts[] = {
    {"fallen_blocks", &Damage::fallen_blocks}, {"hinges", &Damage::hinges}};

/// In SI units, angles in degrees.
inline constexpr std::pair<const char*, double Damage::*> damage_fields[] = {
    {"fallen_area_m2", &Damage::fallen_area},
    {"fallen_weight_n_m", &Damage::fallen_weight},
    {"largest_block_pressure_pa", &Damage::largest_block_pressure},
    {"largest_fallen_area_m2", &Damage::largest_fallen_area},
    {"largest_fallen_weight_n_m", &Damage::largest_fallen_weight},
    {"fallen_depth_m", &Damage::fallen_depth},
    {"fallen_depth_crown_m", &Damage::fallen_depth_crown},
    {"fallen_depth_left_m", &Damage::fallen_depth_left},
    {"fallen_depth_right_m", &Damage::fallen_depth_right},
    {"fallen_depth_invert_m", &Damage::fallen_depth_invert},
    {"opening_filled_ratio", &Damage::opening_filled_ratio},
    {"loosened_area_m2", &Damage::loosened_area},
    {"displacement_max_m", &Damage::displacement_max},
    {"rotation_max_deg", &Damage::rotation_max},
    {"slip_max_m", &Damage::slip_max},
    {"slip_max_ever_m", &Damage::slip_max_ever},
    {"slip_mean_m", &Damage::slip_mean},
    {"slipped_length_m", &Damage::slipped_length},
    {"slipped_length_ever_m", &Damage::slipped_length_ever},
    {"opening_max_m", &Damage::opening_max},
    {"opening_max_ever_m", &Damage::opening_max_ever},
    {"opened_length_m", &Damage::opened_length},
    {"opened_length_ever_m", &Damage::opened_length_ever},
    {"closure_vertical_m", &Damage::closure_vertical},
    {"closure_horizontal_m", &Damage::closure_horizontal}};
static_assert(sizeof(Damage) ==
                  std::size(damage_counts) * sizeof(int) + std::size(damage_fields) * sizeof(double),
              "a measure of the damage is missing");

/// All names, counts first.
inline std::vector<std::string> damage_names() {
  std::vector<std::string> names;
  for (const auto& [name, member] : damage_counts) names.emplace_back(name);
  for (const auto& [name, member] : damage_fields) names.emplace_back(name);
  return names;
}

/// The measure of this name. Throws std::invalid_argument where there is none.
inline double damage_value(const Damage& damage, std::string_view measure) {
  for (const auto& [name, member] : damage_counts) {
    if (measure == name) return damage.*member;
  }
  for (const auto& [name, member] : damage_fields) {
    if (measure == name) return damage.*member;
  }
  throw std::invalid_argument("no measure of damage '" + std::string(measure) + "'");
}

}  // namespace keyblock::simulation
