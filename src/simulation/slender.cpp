#include "simulation/slender.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/index.h"
#include "geometry/moments.h"

namespace keyblock::simulation {

using dynamics::Block;

namespace {
constexpr double pressed = 0.25;  // of σ_b
constexpr int order_of_bending = 3;

/// About the principal axes of a block.
struct Principal {
  double least = 0.0,
         most = 0.0;  ///< ∫ s² dA across the long axis, and along it, over the square of the radius
  Vec2 axis;          ///< the long one
};

Principal principal_of(const Block& block) {
  const Moments m(block.reference, block.centroid, block.radius, 2);
  const double xx = m(2, 0), yy = m(0, 2), xy = m(1, 1), mean = 0.5 * (xx + yy),
               apart = std::hypot(0.5 * (xx - yy), xy), angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return {mean - apart, mean + apart, {std::cos(angle), std::sin(angle)}};
}

/// Per block, whether another one presses against a long side.
std::vector<bool> held_at_sides(const dynamics::Model& model, std::span<const contact::Contact> contacts) {
  constexpr double across = 0.5;  // of a unit normal along the axis, at most
  std::vector<bool> held(model.blocks.size(), false);
  for (const contact::Contact& c : contacts) {
    if (!(c.memory.normal_force > 0.0)) continue;
    for (const int b : {c.block_a, c.block_b})
      if (!held[at(b)] && model.moves(at(b)))
        held[at(b)] = std::abs(dot(principal_of(model.blocks[at(b)]).axis, c.normal)) < across;
  }
  return held;
}

}  // namespace

double buckling_ratio(const Block& block, const double* position) {
  const Principal principal = principal_of(block);
  // The stress is that of the block as it lies now, the axis that of its reference: what has turned is no column any more.
  const Vec2 axis = principal.axis;
  const block::Stress s = block.elasticity.mean_cauchy(position);
  const double pressure = -(s.xx * axis.x * axis.x + 2.0 * s.xy * axis.x * axis.y + s.yy * axis.y * axis.y);
  const double buckles =
      std::numbers::pi * std::numbers::pi / 48.0 * block.material.young * principal.least / principal.most;
  return std::max(0.0, pressure / buckles);
}

std::optional<std::vector<int>> orders_that_bend(const dynamics::Model& model, const dynamics::State& state,
                                                 std::span<const contact::Contact> contacts) {
  std::vector<int> orders;
  bool changes = false;
  const std::vector<bool> held = held_at_sides(model, contacts);
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    const int order = block.basis.order();
    const bool stays = order >= order_of_bending || !model.moves(b) || held[b] ||
                       buckling_ratio(block, &state.position[block.first]) < pressed;
    orders.push_back(stays ? order : order_of_bending);
    changes |= !stays;
  }
  if (!changes) return {};
  return orders;
}

}  // namespace keyblock::simulation
