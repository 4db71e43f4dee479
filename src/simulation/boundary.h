#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "coupling/rock_column.h"
#include "geometry/vec2.h"
#include "record/boundary.h"

namespace keyblock::simulation {

/// Rock far away, on one side of the model.
enum class ColumnSide { left, right };

/// A joint through the whole model, level or nearly so, that goes on in the rock beside it and may slip there.
struct FarPlane {
  std::string joint;                           ///< the set or map that it is of
  std::array<dynamics::RockPlane, 2> at_side;  ///< as it is in the rock on the left and on the right
  double mobilized =
      0.0;  ///< largest share of its strength that the shaking asks for in rock that is elastic
};

/// The rock around the model; see the user guide. Heights are local.
struct Boundary {
  bool compliant = true;  ///< waves go down through the base; else it is rigid
  record::Sides sides = record::Sides::free_field;
  bool overburden = false;                        ///< the top of the model is below the ground …
  double depth = 0.0;                             ///< … by this, m
  Vec2 dashpots;                                  ///< Pa s/m, of the half-space below a compliant base
  std::vector<dynamics::RockLayer> layers;        ///< beside the model, from above
  std::vector<dynamics::RockLayer> right_layers;  ///< those on the right, where they differ; else empty
  std::string source;                             ///< what the layers are taken from
  std::vector<FarPlane> planes;
  [[nodiscard]] const std::vector<dynamics::RockLayer>& layers_at(ColumnSide side) const {
    return side == ColumnSide::right && !right_layers.empty() ? right_layers : layers;
  }
  double fastest = 25.0;  ///< Hz, that waves beside the model are followed up to
};

}  // namespace keyblock::simulation
