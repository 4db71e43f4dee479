#include "simulation/base.h"

#include <cmath>
#include <vector>

namespace keyblock::simulation {
namespace {

/// Of the larger of two values: what rounding may make of the same point of two tables.
constexpr double rounding = 1e-9;

// Both are linear between all rows of the two.
bool are_same(const loading::TimeTable& a, const loading::TimeTable& b) {
  const auto value = [](const loading::TimeTable& table, double t) { return table.empty() ? 0.0 : table(t); };
  for (const loading::TimeTable* table : {&a, &b}) {
    for (const auto& [t, row] : table->rows()) {
      const double x = value(a, t), y = value(b, t);
      if (std::abs(x - y) > rounding * std::max(std::abs(x), std::abs(y))) return false;
    }
  }
  return true;
}

}  // namespace

bool move_alike(std::span<const FixedMotion> fixed) {
  for (const FixedMotion& other : fixed) {
    if (!are_same(fixed.front().x, other.x) || !are_same(fixed.front().y, other.y)) return false;
  }
  return true;
}

dynamics::GroundMove far_ground(const dynamics::Model& model, const dynamics::State& state, Vec2 place) {
  dynamics::GroundMove move;
  for (std::size_t k = 0; k < model.couplings.size(); ++k) {
    const dynamics::FarField* far = model.couplings[k]->far_field();
    if (far == nullptr) continue;
    const dynamics::GroundMove of_one = far->far_ground(state.couplings[k], place);
    move.displacement += of_one.displacement;
    move.velocity += of_one.velocity;
  }
  return move;
}

Base::Base(const RunSetup& setup, const dynamics::Model& model) : model_(model) {
  std::vector<FixedMotion> fixed;
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    const BlockProperties& block = setup.properties[b];
    if (!block.fixed) continue;
    fixed.push_back({block.motion_x, block.motion_y});
    if (!block.motion_x.empty() || !block.motion_y.empty()) block_ = b;
  }
  const loading::TimeTable still;
  if (setup.frame) fixed.push_back({still, still});
  if (!move_alike(fixed)) block_.reset();
}

Vec2 Base::of_block(const std::vector<double>& coefficients) const {
  const dynamics::Block& block = model_.blocks[*block_];
  return Vec2{coefficients[block.first], coefficients[block.first + 1]} / std::sqrt(block.area);
}

Vec2 Base::displacement(const dynamics::State& state, Vec2 place) const {
  if (!block_) return far_ground(model_, state, place).displacement;
  return of_block(state.position) - model_.blocks[*block_].centroid;
}

Vec2 Base::velocity(const dynamics::State& state, Vec2 place) const {
  return block_ ? of_block(state.velocity) : far_ground(model_, state, place).velocity;
}

}  // namespace keyblock::simulation
