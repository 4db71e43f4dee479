#pragma once
#include <optional>
#include <vector>

#include "coupling/rock_column.h"
#include "geometry/vec2.h"

namespace keyblock::simulation {

/// What holds the sides of the rock, and what they let out.
enum class Sides {
  free_field,  ///< rock far away, which moves as it would without the model
  viscous,     ///< rock at rest, which takes up waves
  roller,      ///< nothing goes through them; what lies at them slides up and down
  frame,       ///< fixed blocks, RunSetup::frame
};

/// As a scenario has it.
constexpr const char* name_of(Sides sides) {
  switch (sides) {
    case Sides::free_field:
      return "free-field";
    case Sides::viscous:
      return "viscous";
    case Sides::roller:
      return "roller";
    case Sides::frame:
      break;
  }
  return "frame";
}

/// Rock far away, on one side of the model.
enum class ColumnSide { left, right };

/// The rock around the model; see the user guide. Heights are local.
struct Boundary {
  bool compliant = true;  ///< waves go down through the base; else it is rigid
  Sides sides = Sides::free_field;
  bool overburden = false;                  ///< the top of the model is below the ground …
  double depth = 0.0;                       ///< … by this, m
  Vec2 dashpots;                            ///< Pa s/m, of the half-space below a compliant base
  std::vector<dynamics::RockLayer> layers;  ///< beside the model, from above
  double fastest = 25.0;                    ///< Hz, that waves beside the model are followed up to
};

}  // namespace keyblock::simulation
