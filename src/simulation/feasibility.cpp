#include "simulation/feasibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "block/elasticity.h"

namespace keyblock::simulation {
namespace {

constexpr double most_strain = 1.0;

/// m, of the blocks that move along gravity.
double height_along(const RunSetup& setup, Vec2 gravity) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    if (setup.properties[b].fixed) continue;
    for (const Vec2 p : setup.system.blocks[b].polygon.outer) {
      lowest = std::min(lowest, dot(p, gravity));
      highest = std::max(highest, dot(p, gravity));
    }
  }
  const double g = norm(gravity);
  return g > 0.0 && highest > lowest ? (highest - lowest) / g : 0.0;
}

/// Pa, of its components.
double largest(const block::Stress& stress) {
  return std::max({std::abs(stress.xx), std::abs(stress.yy), std::abs(stress.xy)});
}

/// Pa, by block: of the weight over the height of all that moves, or what an excavation releases. Fixed blocks have none.
std::vector<double> stresses(const RunSetup& setup, double height) {
  const double g = norm(setup.gravity);
  const bool excavates =
      std::ranges::any_of(setup.stages, [](const record::Stage& stage) { return !stage.excavate.empty(); });
  std::vector<double> stress(setup.properties.size(), 0.0);
  for (std::size_t b = 0; b < stress.size(); ++b) {
    const BlockProperties& of_block = setup.properties[b];
    if (of_block.fixed) continue;
    stress[b] = std::max(
        of_block.material.density * g * height,
        excavates ? largest(block::in_situ_at(setup.in_situ, centroid(setup.system.blocks[b].polygon)))
                  : 0.0);
  }
  return stress;
}

/// Pa/m, of the joints that give a stiffness; infinite where none does.
double softest_joint(const RunSetup& setup) {
  double softest = HUGE_VAL;
  const auto see = [&](const contact::JointProperties& joint) {
    softest = std::min(softest, joint.normal_stiffness.value_or(HUGE_VAL));
  };
  see(setup.joints.standard);
  for (const contact::JointProperties& joint : setup.joints.joint_sets) see(joint);
  for (const contact::JointProperties& joint : setup.joints.trace_maps) see(joint);
  return softest;
}

std::optional<std::string> soft_rock(const RunSetup& setup) {
  const double height = height_along(setup, setup.gravity);
  const std::vector<double> stress = stresses(setup, height);
  double worst = 0.0;
  std::size_t softest = 0;
  for (std::size_t b = 0; b < stress.size(); ++b) {
    const double strain = stress[b] / setup.properties[b].material.young;
    if (!(strain > worst)) continue;
    worst = strain;
    softest = b;
  }
  if (worst <= most_strain) return std::nullopt;
  const BlockProperties& of_block = setup.properties[softest];
  return fmt::format(
      "the rock is too soft to be computed: young = {:.4g} Pa{}, and weight or stress of {:.3g} Pa deform it "
      "by {:.2g} times its size (density {:.4g} kg/m3, height {:.3g} m); in which unit is young given?",
      of_block.material.young, of_block.name.empty() ? "" : " of block '" + of_block.name + "'",
      stress[softest], worst, of_block.material.density, height);
}

std::optional<std::string> soft_joints(const RunSetup& setup) {
  const JointClosure worst = largest_closure(setup);
  if (worst.share() <= most_joint_closure) return std::nullopt;
  return fmt::format(
      "the joints are too soft to be computed: normal_stiffness = {:.4g} Pa/m, and weight or stress of "
      "{:.3g} Pa closes them by {:.2g} m, where blocks are {:.2g} m large; in which unit is it given?",
      worst.stiffness, worst.stress, worst.closure, worst.block_size);
}

}  // namespace

JointClosure largest_closure(const RunSetup& setup) {
  JointClosure result;
  const std::vector<double> stress = stresses(setup, height_along(setup, setup.gravity));
  double whole = 0.0;
  int count = 0;
  for (std::size_t b = 0; b < stress.size(); ++b) {
    if (setup.properties[b].fixed) continue;
    result.stress = std::max(result.stress, stress[b]);
    whole += area(setup.system.blocks[b].polygon);
    ++count;
  }
  result.stiffness = softest_joint(setup);
  if (count == 0) return result;
  result.block_size = std::sqrt(whole / count);
  result.closure = result.stress / result.stiffness;
  return result;
}

std::string memory_purpose(const RunSetup& setup) {
  return fmt::format("a model of {} blocks", setup.system.blocks.size());
}

std::optional<std::string> yields_without_limit(const RunSetup& setup) {
  if (auto reason = soft_rock(setup)) return reason;
  return soft_joints(setup);
}

}  // namespace keyblock::simulation
