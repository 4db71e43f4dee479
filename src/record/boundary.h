#pragma once
#include <string>
#include <vector>

#include "geometry/vec2.h"

namespace keyblock::record {

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

/// Rock far away, from a height downwards to the next layer (dynamics::RockLayer).
struct LayerRecord {
  double top = 0.0;      ///< m, local
  double density = 0.0;  ///< kg/m³
  Vec2 speeds;           ///< m/s, of waves that go up and down, by shear (x) and by compression (y)
};

/// The rock around the model (Boundary).
struct BoundaryRecord {
  bool compliant = true;  ///< waves go down through the base; else it is rigid
  Sides sides = Sides::free_field;
  bool overburden = false;                ///< the top of the model is below the ground
  Vec2 dashpots;                          ///< Pa s/m, of the half-space below a compliant base
  std::vector<LayerRecord> layers;        ///< beside the model, from above
  std::vector<LayerRecord> right_layers;  ///< those on the right, where they differ; else empty
  std::string source;                     ///< what the layers are taken from
};

}  // namespace keyblock::record
