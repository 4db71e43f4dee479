#include "simulation/order_control.h"

#include <algorithm>
#include <cmath>

#include "simulation/build_model.h"

namespace keyblock::simulation {

using dynamics::Block;
using dynamics::Model;
using dynamics::State;

namespace {
std::vector<int> orders_of(const Model& model) {
  std::vector<int> orders;
  for (const Block& block : model.blocks) orders.push_back(block.basis.order());
  return orders;
}
}  // namespace

std::vector<int> blocks_by_order(const Model& model) {
  std::vector<int> count;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!model.moves(b)) continue;
    const auto order = static_cast<std::size_t>(model.blocks[b].basis.order());
    if (count.size() <= order) count.resize(order + 1, 0);
    ++count[order];
  }
  return count;
}

bool OrderControl::active() const {
  return std::any_of(setup_.properties.begin(), setup_.properties.end(),
                     [](const BlockProperties& p) { return p.automatic_order && !p.fixed; });
}

bool OrderControl::chooses(const Model& model, std::size_t b) const {
  return b < setup_.properties.size() && setup_.properties[b].automatic_order && model.moves(b);
}

bool OrderControl::apply(Model& model, State& state, std::vector<int> orders) {
  if (orders == orders_of(model)) return false;
  change_orders(setup_, model, state, orders);
  memory_.orders = std::move(orders);
  return true;
}

void OrderControl::restore(Model& model) const {
  if (memory_.orders.empty()) return;
  State start = initial_state(setup_, model);
  change_orders(setup_, model, start, memory_.orders);
}

bool OrderControl::begin(Model& model, State& state) {
  memory_.lowered.assign(model.blocks.size(), 0);
  std::vector<int> orders = orders_of(model);
  for (std::size_t b = 0; b < orders.size(); ++b) {
    if (chooses(model, b)) orders[b] = std::max(orders[b], std::min(2, setup_.automatic_order.highest_order));
  }
  return apply(model, state, std::move(orders));
}

bool OrderControl::adapt(Model& model, State& state) {
  const std::vector<double> eta = indicators(model, state);
  std::vector<int> orders = orders_of(model);
  for (std::size_t b = 0; b < orders.size(); ++b) {
    if (!chooses(model, b) || orders[b] < 2 || memory_.lowered[b] != 0) continue;
    if (eta[b] > setup_.automatic_order.stress_accuracy) {
      orders[b] = std::min(orders[b] + 1, setup_.automatic_order.highest_order);
    } else if (eta[b] < 0.25 * setup_.automatic_order.stress_accuracy) {
      --orders[b];
      memory_.lowered[b] = 1;
    }
  }
  return apply(model, state, std::move(orders));
}

std::vector<double> OrderControl::indicators(const Model& model, const State& state) {
  double squares = 0.0, area = 0.0;
  std::vector<double> eta(model.blocks.size(), 0.0);
  std::vector<double> lower;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!model.moves(b)) continue;
    const Block& block = model.blocks[b];
    const double* a = &state.position[block.first];
    squares += block.elasticity.squared_stress(a, nullptr);
    area += block.area;
    if (block.basis.order() < 2) continue;
    lower.assign(a, a + 2 * block.size);
    std::fill(lower.begin() + 2 * block::basis_size(block.basis.order() - 1), lower.end(), 0.0);
    eta[b] = std::sqrt(block.elasticity.squared_stress(a, lower.data()) / block.area);
  }
  if (squares <= 0.0) return std::vector<double>(eta.size(), 0.0);
  for (double& value : eta) value /= std::sqrt(squares / area);
  return eta;
}

}  // namespace keyblock::simulation
