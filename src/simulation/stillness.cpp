#include "simulation/stillness.h"

#include <algorithm>

#include "core/index.h"

namespace keyblock::simulation {

namespace {
constexpr double weak_share = 0.05;  // of the largest acceleration
}

bool Stillness::is_still(const contact::Surface& surface, double time) {
  if (time < begin_) return false;
  if (memory_.places.empty() || !stays(surface)) {
    memory_.places = surface.position;
    memory_.since = time;
    return false;
  }
  return time - memory_.since >= time_;
}

bool Stillness::stays(const contact::Surface& surface) const {
  for (std::size_t v = 0; v < surface.position.size(); ++v) {
    const double moved = squared_norm(surface.position[v] - memory_.places[v]);
    if (!(moved <= distance_ * distance_) && surface.present[at(surface.block[v])] != 0) return false;
  }
  return true;
}

double end_of_shaking(const loading::GroundMotion& motion, double duration, double least) {
  const std::vector<double>& times = motion.times();
  const std::vector<Vec2>& accelerations = motion.accelerations();
  double largest = 0.0, last = 0.0;
  const auto for_samples = [&](const auto& body) {
    for (std::size_t k = 0; k < times.size() && times[k] <= duration; ++k)
      body(times[k], norm(accelerations[k]));
  };
  for_samples([&](double /*time*/, double a) { largest = std::max(largest, a); });
  for_samples([&](double time, double a) {
    if (a > std::min(weak_share * largest, least)) last = time;
  });
  return last;
}

}  // namespace keyblock::simulation
