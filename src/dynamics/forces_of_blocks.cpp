#include "dynamics/forces_of_blocks.h"

#include "core/index.h"

namespace keyblock::dynamics {

std::vector<Vec2> forces_of_blocks(const Model& model, const StepProblem& problem,
                                   std::span<const contact::Contact> contacts,
                                   std::span<const std::uint8_t> sources) {
  std::vector<Vec2> forces(model.surface.position.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const bool from_a = sources[at(contacts[c].block_a)] != 0, from_b = sources[at(contacts[c].block_b)] != 0;
    if (from_a == from_b) continue;
    const Row& row = problem.rows()[c];
    const Vec2 gradient = row.gradient(problem.springs().force(c));
    if (from_b) {
      forces[row.vertex] -= gradient;
    } else if (problem.points().is_on_curve(row.from)) {
      problem.points().for_vertices_of_curve(
          c, [&](std::size_t v, double share) { forces[v] += share * gradient; });
    } else {
      forces[row.from] += (1.0 - row.position) * gradient;
      forces[row.to] += row.position * gradient;
    }
  }
  return forces;
}

}  // namespace keyblock::dynamics
