#include "contact/corners.h"

#include <algorithm>
#include <array>

#include "contact/candidates.h"
#include "core/index.h"

namespace keyblock::contact {

namespace {

void measure_corners(const Surface& surface, std::size_t begin, std::size_t end, std::span<Corner> corners) {
  for (std::size_t first = begin; first < end; first += lane_count) {
    const std::size_t count = std::min(end - first, std::size_t{lane_count});
    std::array<Vec2, lane_count> along;
    for (std::size_t i = 0; i < lane_count; ++i) {
      const std::size_t e = first + (i < count ? i : 0);
      along[i] = surface.position[at(surface.next[e])] - surface.position[e];
    }
    const Lanes x = each_lane([&](std::size_t i) { return along[i].x; }),
                y = each_lane([&](std::size_t i) { return along[i].y; }), length = square_root(x * x + y * y),
                tx = x / length, ty = y / length;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t e = first + i, next = at(surface.next[e]);
      Corner &corner = corners[e], &after = corners[next];
      corner.position = surface.position[e];
      corner.length = length[i];
      // One by one: two numbers that are stored singly cannot be loaded as one vector at once.
      corner.tangent.x = after.before.x = tx[i];
      corner.tangent.y = after.before.y = ty[i];
      corner.kinds = static_cast<double>(surface.kind[e]) + 4.0 * static_cast<double>(surface.kind[next]);
    }
  }
}

}  // namespace

void Corners::measure(const Surface& surface, ThreadTeam& team) {
  corners_.resize(surface.position.size());
  wholes_.resize(surface.divided.size());
  team.for_range(corners_.size(), contacts_worth_threads,
                 [&](std::size_t begin, std::size_t end) { measure_corners(surface, begin, end, corners_); });
  if (wholes_.empty()) return;
  team.for_range(wholes_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const DividedEdge& whole = surface.divided[e];
      wholes_[e] = {surface.position[at(whole.first)],
                    surface.position[at(surface.next[at(whole.first + whole.pieces - 1)])],
                    surface.start_share[e], static_cast<double>(whole.pieces)};
    }
  });
}

}  // namespace keyblock::contact
