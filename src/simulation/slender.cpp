#include "simulation/slender.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/moments.h"

namespace keyblock::simulation {

using dynamics::Block;

namespace {
constexpr double pressed = 0.25;  // of σ_b
constexpr int order_of_bending = 3;
}  // namespace

double buckling_ratio(const Block& block, const double* position) {
  const Moments m(block.reference, block.centroid, block.radius, 2);
  const double xx = m(2, 0), yy = m(0, 2), xy = m(1, 1), mean = 0.5 * (xx + yy),
               apart = std::hypot(0.5 * (xx - yy), xy), angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  // The stress is that of the block as it lies now, the axis that of its reference: what has turned is no column any more.
  const Vec2 axis{std::cos(angle), std::sin(angle)};
  const block::Stress s = block.elasticity.mean_cauchy(position);
  const double pressure = -(s.xx * axis.x * axis.x + 2.0 * s.xy * axis.x * axis.y + s.yy * axis.y * axis.y);
  const double buckles =
      std::numbers::pi * std::numbers::pi / 48.0 * block.material.young * (mean - apart) / (mean + apart);
  return std::max(0.0, pressure / buckles);
}

std::optional<std::vector<int>> orders_that_bend(const dynamics::Model& model, const dynamics::State& state) {
  std::vector<int> orders;
  bool changes = false;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    const int order = block.basis.order();
    const bool bends = order >= order_of_bending || !model.moves(b) ||
                       buckling_ratio(block, &state.position[block.first]) < pressed;
    orders.push_back(bends ? order : order_of_bending);
    changes |= !bends;
  }
  if (!changes) return {};
  return orders;
}

}  // namespace keyblock::simulation
