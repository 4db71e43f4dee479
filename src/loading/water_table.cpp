#include "loading/water_table.h"

#include <algorithm>
#include <cmath>

namespace keyblock::loading {

double WaterTable::height(double x) const {
  if (x <= points_.front().x) return points_.front().y;
  if (x >= points_.back().x) return points_.back().y;
  const auto next = std::ranges::upper_bound(points_, x, {}, &Vec2::x);
  const Vec2 a = *(next - 1), b = *next;
  return std::lerp(a.y, b.y, (x - a.x) / (b.x - a.x));
}

double WaterTable::head(Vec2 place) const {
  return std::max(0.0, height(place.x) - place.y);
}

WaterTable::Shares WaterTable::shares(Vec2 from, Vec2 to, double first, double last) const {
  const auto depth = [&](double s) {
    const Vec2 place = lerp(from, to, s);
    return height(place.x) - place.y;
  };
  std::vector<double> ends{first};
  for (const Vec2 knot : points_) {
    const double s = (knot.x - from.x) / (to.x - from.x);
    if (s > first && s < last) ends.push_back(s);
  }
  ends.push_back(last);
  std::ranges::sort(ends);
  Shares shares{.is_straight = ends.size() == 2};
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    double s0 = ends[k], s1 = ends[k + 1], h0 = depth(s0), h1 = depth(s1);
    if (h0 <= 0.0 && h1 <= 0.0) continue;
    if (h0 < 0.0) {
      s0 = std::lerp(s0, s1, h0 / (h0 - h1));
      h0 = 0.0;
      shares.is_straight = false;
    } else if (h1 < 0.0) {
      s1 = std::lerp(s0, s1, h0 / (h0 - h1));
      h1 = 0.0;
      shares.is_straight = false;
    }
    const double length = s1 - s0, sum = 0.5 * (h0 + h1) * length,
                 of_end = length * (h0 * (2.0 * s0 + s1) + h1 * (s0 + 2.0 * s1)) / 6.0;
    shares.end += of_end;
    shares.start += sum - of_end;
  }
  return shares;
}

}  // namespace keyblock::loading
