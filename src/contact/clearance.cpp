#include <algorithm>
#include <cmath>

#include "contact/candidates.h"
#include "contact/line_motion.h"
#include "core/index.h"

namespace keyblock::contact {

double clearance(const Surface& surface, std::span<const Vec2> position, const Tolerances& tolerances,
                 int vertex, int edge) {
  const int end = surface.next[at(edge)];
  const Vec2 a = position[at(edge)], v = position[at(vertex)], along_edge = position[at(end)] - a;
  const double length = norm(along_edge);
  const Vec2 tangent = along_edge / length, normal{tangent.y, -tangent.x};
  const double gap = dot(normal, v - a), along = dot(tangent, v - a);

  const double deepest = std::min({tolerances.depth_limit, surface.thickness[at(surface.block[at(vertex)])],
                                   surface.thickness[at(surface.block[at(edge)])]});
  const auto zone = [&](int corner) {
    return surface.is_concave(at(corner)) ? std::max(deepest, tolerances.end_zone) : tolerances.end_zone;
  };
  const double apart = std::max(
      {gap - tolerances.activation, -gap - deepest, -along - zone(edge), along - length - zone(end)});
  double clear = std::min(apart / (4.0 + line_turn * norm(v - a) / length), largest_line_motion * length);

  for (const int other : {surface.previous[at(vertex)], surface.next[at(vertex)]}) {
    const Vec2 u = position[at(other)] - v;
    const double size = norm(u), shortest = std::min(size, length);
    const double inside = -dot(normal, u) / size - Tolerances::sine_inside;
    clear = std::max(clear, std::min(inside / line_turn, largest_line_motion) * shortest);
  }
  return std::max(0.0, clear);
}

}  // namespace keyblock::contact
