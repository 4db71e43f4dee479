#include "simulation/wall_movement.h"

#include <limits>

#include "core/index.h"

namespace keyblock::simulation {

std::vector<Vec2> ends_of(std::span<const dynamics::WallFace> faces, const dynamics::Model& model) {
  const contact::Surface& surface = model.surface;
  std::vector<Vec2> ends;
  for (const dynamics::WallFace& face : faces) {
    const Vec2 from = surface.position[at(face.vertex)],
               to = surface.position[at(surface.next[at(face.vertex)])];
    ends.push_back(lerp(from, to, face.from));
    ends.push_back(lerp(from, to, face.to));
  }
  return ends;
}

WallMovement movement_of(std::span<const dynamics::WallFace> faces, const dynamics::Model& model, Vec2 centre,
                         std::span<const Vec2> start) {
  const std::vector<Vec2> now = ends_of(faces, model);
  const auto is_there = [&](std::size_t k) {
    return model.surface.present[at(model.surface.block[at(faces[k].vertex)])] != 0;
  };
  // Of the faces that a line meets, the farthest.
  const auto along = [&](Vec2 out) {
    double reach = 0.0, inwards = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t k = 0; k < faces.size(); ++k) {
      const Vec2 a = start[2 * k] - centre, b = start[2 * k + 1] - centre;
      const double of_a = cross(out, a), of_b = cross(out, b);
      if (!is_there(k) || (of_a >= 0.0) == (of_b >= 0.0)) continue;
      const double share = of_a / (of_a - of_b), distance = dot(out, lerp(a, b, share));
      if (distance <= reach) continue;
      reach = distance;
      inwards = -dot(out, lerp(now[2 * k] - start[2 * k], now[2 * k + 1] - start[2 * k + 1], share));
    }
    return inwards;
  };
  double area = 0.0, length = 0.0;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    if (!is_there(k)) continue;
    const Vec2 edge = start[2 * k + 1] - start[2 * k],
               moved = lerp(now[2 * k] - start[2 * k], now[2 * k + 1] - start[2 * k + 1], 0.5);
    area -= dot(perpendicular(edge), moved);
    length += norm(edge);
  }
  return {along({0.0, 1.0}), 0.5 * (along({1.0, 0.0}) + along({-1.0, 0.0})),
          length > 0.0 ? area / length : std::numeric_limits<double>::quiet_NaN()};
}

}  // namespace keyblock::simulation
