#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/polygon.h"
#include "record/record.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

/// By a direction out of an opening: up and down within 45°, sides else. `down`: unit vector.
record::WallPart part_towards(Vec2 out, Vec2 down);

/// What the outlines of the excavations that are open cover together. Coordinates are those of the reference position.
class Openings {
 public:
  /// `open`: of every excavation, whether it is.
  void unite(std::span<const Excavation> excavations, std::span<const std::uint8_t> open);

  [[nodiscard]] double area() const;  ///< m²
  /// m² of a polygon that lie inside.
  [[nodiscard]] double area_inside(const Polygon& block) const;

  /// The corner of a block that is farthest from the outlines.
  struct Place {
    double depth = 0.0;                              ///< m, from the nearest point of an outline
    record::WallPart part = record::WallPart::none;  ///< by the direction from there to the corner
  };
  /// `down`: unit vector. `part` is `none` without openings.
  [[nodiscard]] Place behind_walls(const Polygon& block, Vec2 down) const;

 private:
  std::vector<Polygon> openings_;
};

}  // namespace keyblock::simulation
