#include "scenario/properties.h"

#include <algorithm>
#include <optional>
#include <utility>

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

}  // namespace keyblock::scenario
