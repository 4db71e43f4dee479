#include "dynamics/energy.h"

#include <cmath>

#include "core/index.h"
#include "coupling/coupling.h"

namespace keyblock::dynamics {

double kinetic_energy(const Model& model, const State& state) {
  double sum = 0.0;
  for (std::size_t b = 0; b < model.bodies(); ++b) {
    if (!model.moves(b)) continue;
    // The basis is orthonormal over the block: its mass matrix is the density times the identity. So it is of nodes.
    const Body& block = model.body(b);
    double squared = 0.0;
    for (std::size_t k = block.first; k < block.first + 2 * at(block.size); ++k)
      squared += state.velocity[k] * state.velocity[k];
    sum += 0.5 * block.material.density * squared;
  }
  return sum;
}

double strain_energy(const Model& model, const State& state) {
  double sum = 0.0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (model.moves(b)) sum += model.blocks[b].elasticity.energy(&state.position[model.blocks[b].first]);
  }
  return sum;
}

double gravity_energy(const Model& model, const State& state) {
  double sum = 0.0;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    if (!model.moves(b)) continue;
    const Block& block = model.blocks[b];
    // The first function of the basis is 1/√A: its coefficients are √A times where the centroid is.
    const Vec2 now{state.position[block.first], state.position[block.first + 1]};
    sum -= block.body_force() * dot(model.gravity, now - std::sqrt(block.area) * block.centroid);
  }
  return sum;
}

double support_energy(const Model& model, const State& state, double time) {
  double sum = 0.0;
  for (std::size_t k = 0; k < model.couplings.size(); ++k)
    sum += model.couplings[k]->stored_energy(model, state, time, state.couplings[k]);
  return sum;
}

}  // namespace keyblock::dynamics
