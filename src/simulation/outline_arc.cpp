#include "simulation/outline_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace keyblock::simulation {

namespace {
constexpr double degree = std::numbers::pi / 180.0;
}  // namespace

double angle_in_arc(Vec2 p, const std::pair<double, double>& arc) {
  const double angle = std::atan2(p.y, p.x) / degree;
  return angle - arc.first - 360.0 * std::floor((angle - arc.first) / 360.0);
}

std::vector<Stretch> within_arc(const Stretch& stretch, Vec2 a, Vec2 b, Vec2 centre,
                                const std::pair<double, double>& arc) {
  std::vector<double> ends{stretch.first, stretch.second};
  for (const double angle : {arc.first, arc.second}) {
    const Vec2 ray{std::cos(angle * degree), std::sin(angle * degree)};
    const double of_a = cross(ray, a - centre), of_b = cross(ray, b - centre);
    if ((of_a > 0.0) == (of_b > 0.0)) continue;
    const double share = of_a / (of_a - of_b);
    if (share > stretch.first && share < stretch.second) ends.push_back(share);
  }
  std::ranges::sort(ends);
  std::vector<Stretch> parts;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    const Vec2 middle = lerp(a, b, 0.5 * (ends[k - 1] + ends[k])) - centre;
    if (angle_in_arc(middle, arc) <= arc.second - arc.first) parts.emplace_back(ends[k - 1], ends[k]);
  }
  return parts;
}

}  // namespace keyblock::simulation
