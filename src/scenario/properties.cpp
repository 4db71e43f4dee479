#include "scenario/properties.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "scenario/own_joints.h"

namespace keyblock::scenario {
namespace {

// Keys of `over` where given, those of `rock` elsewhere.
RockKeys layered(RockKeys rock, const RockKeys& over) {
  if (over.density) rock.density = over.density;
  if (over.young) rock.young = over.young;
  if (over.poisson) rock.poisson = over.poisson;
  if (over.state) rock.state = over.state;
  if (over.order) rock.order = over.order;
  return rock;
}

// A factor of 1 keeps every bit.
void reduce_strength(contact::JointProperties& joint, double factor) {
  if (factor == 1.0) return;
  const double degree = std::numbers::pi / 180.0;
  joint.friction = std::atan(std::tan(joint.friction * degree) / factor) / degree;
  joint.cohesion /= factor;
  joint.tension /= factor;
  if (!joint.residual) return;
  joint.residual->friction = std::atan(std::tan(joint.residual->friction * degree) / factor) / degree;
  joint.residual->cohesion /= factor;
}

contact::JointProperties joint_properties(const JointKeys& own, const JointKeys& standard) {
  const auto pick = [](const std::optional<double>& first, const std::optional<double>& second) {
    return first ? first : second;
  };
  contact::JointProperties joint;
  joint.friction = pick(own.friction, standard.friction).value_or(0.0);
  joint.cohesion = pick(own.cohesion, standard.cohesion).value_or(0.0);
  joint.tension = pick(own.tension, standard.tension).value_or(0.0);
  joint.normal_stiffness = pick(own.normal_stiffness, standard.normal_stiffness);
  const auto shear = pick(own.shear_stiffness, standard.shear_stiffness);
  if (shear && joint.normal_stiffness) joint.stiffness_ratio = *shear / *joint.normal_stiffness;
  if (own.has_residual() || standard.has_residual()) {
    const double friction = pick(own.residual_friction, standard.residual_friction).value_or(joint.friction),
                 cohesion = pick(own.residual_cohesion, standard.residual_cohesion).value_or(0.0);
    // A set may have less strength than what [joints] say is left.
    joint.residual = {std::min(friction, joint.friction), std::min(cohesion, joint.cohesion),
                      pick(own.weakening_slip, standard.weakening_slip).value_or(0.0)};
    if (joint.residual->friction == joint.friction && joint.residual->cohesion == 0.0 &&
        joint.residual->slip == 0.0)
      joint.residual.reset();  // a bond that slips loses its cohesion anyway
  }
  reduce_strength(joint, pick(own.strength_factor, standard.strength_factor).value_or(1.0));
  return joint;
}

}  // namespace

std::vector<simulation::BlockProperties> properties_of(const Scenario& scenario,
                                                       const cutting::BlockSystem& system) {
  const std::size_t cut = system.blocks.size() - scenario.blocks.size();
  std::vector<simulation::BlockProperties> all;
  for (std::size_t b = 0; b < system.blocks.size(); ++b) {
    const Vec2 centre = centroid(system.blocks[b].polygon) + system.origin;
    RockKeys rock = scenario.rock;
    for (const RegionSpec& region : scenario.regions) {
      if (contains(region.polygon, centre)) rock = layered(rock, region.rock);
    }
    simulation::BlockProperties properties;
    if (b >= cut) {
      const BlockSpec& spec = scenario.blocks[b - cut];
      rock = layered(rock, spec.rock);
      properties.name = spec.name;
      properties.fixed = spec.fixed;
      properties.motion_x = spec.motion_x;
      properties.motion_y = spec.motion_y;
      properties.velocity = spec.velocity;
      properties.spin = spec.spin;
    }
    properties.material = {*rock.density, *rock.young, *rock.poisson, *rock.state};
    properties.automatic_order = *rock.order == automatic_order;
    properties.order = properties.automatic_order ? 1 : *rock.order;
    all.push_back(std::move(properties));
  }
  return all;
}

simulation::JointTable joint_table(const Scenario& scenario) {
  simulation::JointTable table;
  table.standard = joint_properties(scenario.joints, {});
  for (const OwnJoints& joints : own_joint_sets(scenario))
    table.joint_sets.push_back(joint_properties(joints.keys, scenario.joints));
  for (const OwnJoints& joints : own_trace_maps(scenario))
    table.trace_maps.push_back(joint_properties(joints.keys, scenario.joints));
  table.frame = table.standard;
  table.frame.friction = scenario.domain ? scenario.domain->frame_friction : 0.0;
  table.frame.cohesion = table.frame.tension = 0.0;
  table.frame.residual.reset();
  return table;
}

}  // namespace keyblock::scenario
