#include "simulation/feasibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "block/elasticity.h"

namespace keyblock::simulation {
namespace {

constexpr double most_strain = 1.0;

/// m, of the model along gravity.
double height_along(const RunSetup& setup, Vec2 gravity) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const cutting::CutBlock& block : setup.system.blocks) {
    for (const Vec2 p : block.polygon.outer) {
      lowest = std::min(lowest, dot(p, gravity));
      highest = std::max(highest, dot(p, gravity));
    }
  }
  const double g = norm(gravity);
  return g > 0.0 ? (highest - lowest) / g : 0.0;
}

/// Pa, of its components.
double largest(const block::Stress& stress) {
  return std::max({std::abs(stress.xx), std::abs(stress.yy), std::abs(stress.xy)});
}

}  // namespace

std::optional<std::string> yields_without_limit(const RunSetup& setup) {
  const double height = height_along(setup, setup.gravity), g = norm(setup.gravity);
  const bool excavates =
      std::ranges::any_of(setup.stages, [](const Stage& stage) { return !stage.excavate.empty(); });
  double worst = 0.0, worst_stress = 0.0;
  const BlockProperties* softest = nullptr;
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    const BlockProperties& of_block = setup.properties[b];
    if (of_block.fixed) continue;
    const double stress = std::max(
        of_block.material.density * g * height,
        excavates ? largest(block::in_situ_at(setup.in_situ, centroid(setup.system.blocks[b].polygon)))
                  : 0.0);
    const double strain = stress / of_block.material.young;
    if (!(strain > worst)) continue;
    worst = strain;
    worst_stress = stress;
    softest = &of_block;
  }
  if (softest == nullptr || worst <= most_strain) return std::nullopt;
  return fmt::format(
      "the rock is too soft to be computed: young = {:.4g} Pa{}, and weight or stress of {:.3g} Pa deform it "
      "by {:.2g} times its size (density {:.4g} kg/m3, height {:.3g} m); in which unit is young given?",
      softest->material.young, softest->name.empty() ? "" : " of block '" + softest->name + "'", worst_stress,
      worst, softest->material.density, height);
}

}  // namespace keyblock::simulation
