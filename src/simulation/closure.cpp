#include "simulation/closure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/index.h"
#include "simulation/base.h"

namespace keyblock::simulation {
namespace {

// The block that holds a point, one of those beside it where the point is on a joint; −1 where there is none.
int moving_block_at(const dynamics::Model& model, Vec2 point) {
  const auto first = [&](bool (*holds)(const Polygon&, Vec2)) {
    for (std::size_t b = 0; b < model.blocks.size(); ++b) {
      if (model.moves(b) && holds(model.blocks[b].reference, point)) return static_cast<int>(b);
    }
    return -1;
  };
  const int inside = first(&contains);
  return inside >= 0 ? inside : first(&lies_in);
}

// Distance of the ends of a diameter now, without what the ground far away moves between them; nothing where one of them is in no block.
std::optional<double> length(const Diameter& d, const dynamics::Model& model, const dynamics::State& state) {
  Vec2 now[2];
  for (int end = 0; end < 2; ++end) {
    if (d.blocks[end] < 0) return std::nullopt;
    const std::size_t b = at(d.blocks[end]);
    if (!model.moves(b)) return std::nullopt;
    const dynamics::Block& block = model.blocks[b];
    std::vector<double> phi(at(block.size));
    block.basis.evaluate(d.ends[end], phi.data());
    for (std::size_t k = 0; k < phi.size(); ++k)
      now[end] += phi[k] * Vec2{state.position[block.first + 2 * k], state.position[block.first + 2 * k + 1]};
    now[end] -= far_ground(model, state, d.ends[end]).displacement;
  }
  return norm(now[0] - now[1]);
}

}  // namespace

Diameter diameter_of(const Ring& outline, Vec2 direction, const dynamics::Model& model,
                     const dynamics::State& state) {
  Diameter d;
  const Vec2 centre = centroid({outline, {}});
  for (int end = 0; end < 2; ++end) {
    const Vec2 out = end == 0 ? direction : -direction;
    // Where a ray from the centre leaves the outline, and a little beyond: in the wall. A corner on the ray is an end of one of the
    // two edges that meet there, never of none.
    double reach = 0.0;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k] - centre, b = outline[(k + 1) % outline.size()] - centre;
      if ((cross(out, a) >= 0.0) == (cross(out, b) >= 0.0)) continue;
      const Vec2 along = b - a;
      const double denominator = cross(out, along);
      if (denominator != 0.0) reach = std::max(reach, cross(a, along) / denominator);
    }
    d.ends[end] = centre + 1.001 * reach * out;
    d.blocks[end] = moving_block_at(model, d.ends[end]);
  }
  d.length = length(d, model, state).value_or(0.0);
  return d;
}

double closure(const Diameter& d, const dynamics::Model& model, const dynamics::State& state,
               std::span<const record::BlockStatus> status) {
  const std::optional<double> now = length(d, model, state);
  if (!now) return d.closure;
  const bool fell = std::any_of(std::begin(d.blocks), std::end(d.blocks),
                                [&](int b) { return status[at(b)] == record::BlockStatus::fallen; });
  return fell ? std::numeric_limits<double>::quiet_NaN() : d.length - *now;
}

}  // namespace keyblock::simulation
