#include "scenario/closure_bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/excavated_blocks.h"
#include "scenario/own_joints.h"

namespace keyblock::scenario {
namespace {

constexpr double large_block = 0.2;  // √area, of the width of the opening
constexpr double most_of = 0.5;      // of the rock near it
constexpr double standard_stiffness = dynamics::SolverOptions{}.penalty;  // Pa/m, of E

/// The rock within one width of an opening, and its part in blocks of order 1.
struct RockNear {
  double area = 0.0, of_order_1 = 0.0, of_large_order_1 = 0.0;  // m²
};

double share_within(const Polygon& block, const Box& box) {
  const Box own = bounds(block);
  if (box.contains(own.min) && box.contains(own.max)) return 1.0;
  return overlay(block, {box.min, {box.max.x, box.min.y}, box.max, {box.min.x, box.max.y}}).share;
}

RockNear rock_near(const simulation::RunSetup& setup, const Ring& outline) {
  Box box = bounds(Polygon{outline, {}});
  const double width = box.max.x - box.min.x;
  box = {box.min - Vec2{width, width}, box.max + Vec2{width, width}};
  RockNear rock;
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    const cutting::CutBlock& block = setup.system.blocks[b];
    const simulation::BlockProperties& properties = setup.properties[b];
    if (properties.fixed || !block.excavations.empty()) continue;
    const double whole = area(block.polygon), within = whole * share_within(block.polygon, box);
    rock.area += within;
    if (properties.order > 1 || properties.automatic_order) continue;
    rock.of_order_1 += within;
    if (std::sqrt(whole) > large_block * width) rock.of_large_order_1 += within;
  }
  return rock;
}

/// Of the stiffest joint, over the default.
double stiffest_joint(const Scenario& scenario) {
  double most = scenario.solver.penalty / standard_stiffness;
  const double standard = standard_stiffness * *scenario.rock.young;
  const auto see = [&](const JointKeys& joints) {
    if (joints.normal_stiffness) most = std::max(most, *joints.normal_stiffness / standard);
  };
  see(scenario.joints);
  for (const OwnJoints& joints : own_joints(scenario)) see(joints.keys);
  return most;
}

}  // namespace

std::optional<std::string> closure_is_lower_bound(const Scenario& scenario,
                                                  const simulation::RunSetup& setup) {
  constexpr double rounding = 1e-6;
  const double stiffness = stiffest_joint(scenario);
  for (std::size_t k = 0; k < setup.excavations.size(); ++k) {
    const bool taken_out = std::ranges::any_of(setup.stages, [&](const record::Stage& stage) {
      return std::ranges::find(stage.excavate, static_cast<int>(k)) != stage.excavate.end();
    });
    if (!taken_out) continue;
    const RockNear rock = rock_near(setup, setup.excavations[k].outline);
    if (rock.of_large_order_1 > most_of * rock.area) {
      return fmt::format(
          "{:.0f} % of the rock within one width of {} is in blocks of order 1 larger than a fifth of that "
          "width; such blocks fit each other and can hardly deform",
          100.0 * rock.of_large_order_1 / rock.area, scenario.excavations[k].path);
    }
    if (rock.of_order_1 > 0.0 && stiffness > 1.0 + rounding) {
      return fmt::format(
          "the joints are {:.3g} times as stiff as the default, {:.4g} Pa/m; blocks of order 1 that fit each "
          "other can hardly deform then",
          stiffness, standard_stiffness * *scenario.rock.young);
    }
  }
  return std::nullopt;
}

}  // namespace keyblock::scenario
