#include "simulation/build_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "core/index.h"
#include "coupling/facets.h"
#include "coupling/ground_springs.h"
#include "coupling/point_springs.h"
#include "geometry/quadrature.h"
#include "simulation/bolt_nodes.h"
#include "simulation/build_bolts.h"
#include "simulation/build_boundary.h"
#include "simulation/build_liners.h"
#include "simulation/build_water.h"
#include "simulation/joint_laws.h"
#include "simulation/outline.h"
#include "simulation/refuse.h"
#include "simulation/spring_blocks.h"
#include "simulation/wall_faces.h"

namespace keyblock::simulation {

using dynamics::Block;
using dynamics::Model;

namespace {

/// Polynomials over a block. Throws InputError where it is so thin, for its order, that they cannot be told from each other.
block::Basis make_basis(const Polygon& polygon, const BlockProperties& properties, int order) {
  try {
    return block::Basis(polygon, order);
  } catch (const std::invalid_argument&) {
    const Box box = bounds(polygon);
    const Vec2 middle = lerp(box.min, box.max, 0.5);
    const std::string name = properties.name.empty() ? "a block" : fmt::format("block '{}'", properties.name);
    refuse(fmt::format("{} about ({:.6g}, {:.6g})", name, middle.x, middle.y),
           fmt::format("an area of {:.3g} within a perimeter of {:.3g}", area(polygon), perimeter(polygon)),
           fmt::format("a block wide enough for polynomials of order {}", order));
  }
}

Block make_block(const Polygon& polygon, const BlockProperties& properties, int order, int edge_order,
                 const std::optional<block::InSituStress>& in_situ) {
  const block::Basis basis = make_basis(polygon, properties, order);
  Block block{{},
              centroid(polygon),
              0.0,
              block::Pose(polygon, basis),
              block::Elasticity(polygon, basis, properties.material, in_situ),
              polygon,
              basis,
              edge_order};
  block.fixed = properties.fixed;
  block.area = area(polygon);
  block.material = properties.material;
  for (const Vec2 p : polygon.outer) block.radius = std::max(block.radius, norm(p - block.centroid));
  block.size = basis.size();
  return block;
}

std::size_t block_named(const RunSetup& setup, const std::string& name, const std::string& key) {
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    if (setup.properties[b].name == name) return b;
  }
  refuse(key, fmt::format("'{}'", name), "the name of a block");
}

void require_on_block(const Polygon& polygon, Vec2 p, const std::string& key, const std::string& block) {
  if (!lies_in(polygon, p)) {
    refuse(key, fmt::format("the point ({}, {})", p.x, p.y), fmt::format("a point of block '{}'", block));
  }
}

void add_loads(const RunSetup& setup, Model& model) {
  for (std::size_t k = 0; k < setup.loads.size(); ++k) {
    const loading::Load& load = setup.loads[k];
    const std::string key = fmt::format("load[{}]", k);
    const std::size_t b = block_named(setup, load.block, key + ".block");
    const Block& block = model.blocks[b];
    require_on_block(block.reference, load.from, key, load.block);
    if (load.is_line) require_on_block(block.reference, load.to, key, load.block);
    dynamics::GeneralizedLoad g{static_cast<int>(b), std::vector<double>(2 * at(block.size), 0.0),
                                load.factor};
    std::vector<double> phi(at(block.size));
    const auto add = [&](Vec2 where, Vec2 force) {
      block.basis.evaluate(where, phi.data());
      for (std::size_t i = 0; i < phi.size(); ++i) {
        g.force[2 * i] += phi[i] * force.x;
        g.force[2 * i + 1] += phi[i] * force.y;
      }
    };
    if (!load.is_line) {
      add(load.from, load.value);
    } else {
      const LineRule& rule =
          gauss_legendre((block.basis.order() + 4) / 2);  // degree n of φ, plus 2 of the traction
      const double length = norm(load.to - load.from);
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        add(lerp(load.from, load.to, rule.points[q]),
            rule.weights[q] * length * load.traction(rule.points[q]));
      }
    }
    model.loads.push_back(std::move(g));
  }
}

/// Springs of a share of the stiffness of support k at a point of block b.
void add_ground_springs(const RunSetup& setup, std::size_t k, const Block& block, std::size_t b, Vec2 where,
                        double stiffness, std::vector<dynamics::GroundSpring>& springs) {
  const loading::Support& support = setup.supports[k];
  for (int axis = 0; axis < 2; ++axis) {
    if (!(axis == 0 ? support.along_x : support.along_y)) continue;
    dynamics::GroundSpring spring{static_cast<int>(b),
                                  k,
                                  axis,
                                  std::vector<double>(at(block.size)),
                                  axis == 0 ? where.x : where.y,
                                  stiffness,
                                  axis == 0 ? support.motion_x : support.motion_y};
    block.basis.evaluate(where, spring.phi.data());
    springs.push_back(std::move(spring));
  }
}

void add_supports(const RunSetup& setup, Model& model) {
  std::vector<dynamics::GroundSpring> springs;
  std::vector<dynamics::SupportedPlace> places;
  for (std::size_t k = 0; k < setup.supports.size(); ++k) {
    const loading::Support& support = setup.supports[k];
    const std::string key =
        support.name.empty() ? fmt::format("support[{}]", k) : fmt::format("support.{}", support.name);
    const std::size_t b = block_named(setup, support.block, key + ".block");
    const Block& block = model.blocks[b];
    for (const Vec2 p : support.points) require_on_block(block.reference, p, key, support.block);
    const double stiffness = support.stiffness.value_or(1000.0 * block.material.young);
    const auto add = [&](Vec2 where, double share) {
      add_ground_springs(setup, k, block, b, where, stiffness * share, springs);
    };
    const auto phi_at = [&](Vec2 where) {
      std::vector<double> phi(at(block.size));
      block.basis.evaluate(where, phi.data());
      return phi;
    };
    places.push_back({support.name.empty() ? key : support.name, static_cast<int>(b),
                      phi_at(support.points.front()), phi_at(support.points.back()), support.points.front(),
                      support.points.back()});
    if (!support.is_edge) {
      for (const Vec2 p : support.points) add(p, 1.0);
    } else {
      const LineRule& rule = gauss_legendre(block.basis.order() + 1);  // φφᵀ has degree 2n
      const double length = norm(support.points[1] - support.points[0]);
      for (std::size_t q = 0; q < rule.points.size(); ++q) {
        add(lerp(support.points[0], support.points[1], rule.points[q]), rule.weights[q] * length);
      }
    }
  }
  if (!springs.empty())
    model.couplings.push_back(
        std::make_shared<dynamics::GroundSprings>(std::move(springs), std::move(places)));
}

void add_springs(const RunSetup& setup, Model& model) {
  BoltSprings all;
  for (std::size_t k = 0; k < setup.springs.size(); ++k) {
    const loading::Spring& spring = setup.springs[k];
    const auto [a, b] = spring_blocks(setup, k);
    for (const auto& [block, p] : {std::pair(a, spring.from), std::pair(b, spring.to)}) {
      all.points.push_back(material_point(model, block, p));
      all.drawn.push_back(all.points.back());
    }
    all.springs.push_back({.name = spring.name.empty() ? fmt::format("spring[{}]", k) : spring.name,
                           .stiffness = spring.stiffness,
                           .yield = spring.yield.value_or(HUGE_VAL),
                           .from = spring.from,
                           .to = spring.to,
                           .staged = spring.staged});
  }
  add_bolts(setup, model, all);
  add_bolts_of_nodes(setup, model, all);
  if (!all.springs.empty())
    model.couplings.push_back(std::make_shared<dynamics::PointSprings>(
        std::move(all.springs), std::move(all.points), std::move(all.drawn)));
}

/// In an order that stays the same: State::couplings is in it.
void add_couplings(const RunSetup& setup, Model& model) {
  add_supports(setup, model);
  add_springs(setup, model);
  if (auto liners = liner_coupling(setup, model)) model.couplings.push_back(std::move(liners));
  if (setup.boundary) {
    model.couplings.push_back(build_boundary(setup, model));
  } else if (auto damping = mass_damping(model)) {
    model.couplings.push_back(std::make_shared<dynamics::FrameDamping>(std::move(*damping)));
  }
  if (auto walls = wall_loads(setup, model)) model.couplings.push_back(std::move(walls));
  if (auto water = joint_water(setup, model)) model.couplings.push_back(std::move(water));
}

void add_prescribed_motions(const RunSetup& setup, Model& model) {
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    const BlockProperties& properties = setup.properties[b];
    if (properties.motion_x.empty() && properties.motion_y.empty()) continue;
    model.motions.push_back(
        {static_cast<int>(b), model.blocks[b].centroid, properties.motion_x, properties.motion_y});
  }
}

/// Blocks that move first, and then lines, so that their coefficients are the unknowns.
void number_coefficients(Model& model) {
  model.coefficients = 0;
  const auto place = [&](dynamics::Body& body) {
    body.first = model.coefficients;
    model.coefficients += 2 * at(body.size);
  };
  for (const bool fixed : {false, true}) {
    for (Block& block : model.blocks) {
      if (block.fixed == fixed) place(block);
    }
    if (fixed) continue;
    for (dynamics::LineBody& line : model.lines) place(line);
    model.unknowns = model.coefficients;
  }
  int next = 0;
  double moving_area = 0.0;
  for (Block& block : model.blocks) {
    if (block.fixed) continue;
    block.unknown = next++;
    moving_area += block.area;
  }
  const int moving = next;
  for (dynamics::LineBody& line : model.lines) line.unknown = next++;
  if (moving > 0) model.block_size = std::sqrt(moving_area / moving);
}

}  // namespace

Polygon frame_polygon(const Box& domain) {
  const double width = 0.05 * std::max(domain.size().x, domain.size().y);
  const Vec2 a = domain.min, b = domain.max;
  const Box outer = domain.grown(width);
  return {{outer.min, {outer.max.x, outer.min.y}, outer.max, {outer.min.x, outer.max.y}},
          {{a, {a.x, b.y}, b, {b.x, a.y}}}};
}

Model build_model(const RunSetup& setup) {
  Model model;
  model.gravity = setup.gravity;
  model.in_situ = setup.in_situ;
  model.solver = setup.solver;
  model.laws = joint_laws(setup);

  std::vector<int> joints;
  model.blocks.reserve(setup.system.blocks.size() + 1);
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    const cutting::CutBlock& cut = setup.system.blocks[b];
    const BlockProperties& properties = setup.properties[b];
    const int order = properties.fixed ? 1 : properties.order;
    const bool automatic = properties.automatic_order && !properties.fixed;
    const int of_block = automatic ? setup.automatic_order.highest_order : order,
              edge_order = properties.fixed ? 1 : std::max(of_block, setup.solver.face_contacts - 1);
    model.blocks.push_back(make_block(cut.polygon, properties, order, edge_order, setup.in_situ));
    for (const auto& ring : cut.labels) {
      for (const cutting::EdgeLabel label : ring) joints.push_back(joint_law(setup, label));
    }
  }
  if (setup.frame) {
    BlockProperties properties;
    properties.fixed = true;
    // No softer than any block that it touches: joints along it are as stiff as the rock has them (contact::Detection).
    for (const BlockProperties& block : setup.properties)
      properties.material.young = std::max(properties.material.young, block.material.young);
    model.blocks.push_back(make_block(frame_polygon(setup.domain), properties, 1, 1, {}));
    joints.insert(joints.end(), 8, 1);
  }
  model.lines = bolt_lines(setup);
  add_liner_lines(setup, model.lines);
  number_coefficients(model);
  build_surface(model, joints);
  find_seams(model);
  for (const cutting::Interface& interface : setup.system.interfaces)
    model.surface.pair_joints.push_back(
        {static_cast<int>(interface.low), static_cast<int>(interface.high), law_of_set(interface.joint)});
  std::ranges::sort(model.surface.pair_joints, {},
                    [](const contact::BlockPairJoint& pair) { return std::pair(pair.low, pair.high); });
  add_loads(setup, model);
  add_couplings(setup, model);
  add_prescribed_motions(setup, model);
  model.water = water_in(setup, 0);
  return model;
}

void change_orders(const RunSetup& setup, Model& model, dynamics::State& state, std::span<const int> orders) {
  std::vector<std::pair<std::size_t, int>> old;  // first coefficient and number of basis functions
  for (std::size_t b = 0; b < model.bodies(); ++b) old.emplace_back(model.body(b).first, model.body(b).size);
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    Block& block = model.blocks[b];
    if (block.fixed || orders[b] == block.basis.order()) continue;
    const int unknown = block.unknown;
    block = make_block(block.reference, setup.properties[b], orders[b], block.edge_order, setup.in_situ);
    block.unknown = unknown;
  }
  number_coefficients(model);
  evaluate_basis(model);
  model.loads.clear();
  model.couplings.clear();
  add_loads(setup, model);
  add_couplings(setup, model);
  // Basis functions are ordered by degree and those of lower degree are the same at every order.
  const auto carry_over = [&](std::vector<double>& values) {
    if (values.empty()) return;
    std::vector<double> now(model.coefficients, 0.0);
    for (std::size_t b = 0; b < model.bodies(); ++b) {
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(old[b].first);
      std::copy_n(from, 2 * std::min(old[b].second, model.body(b).size),
                  now.begin() + static_cast<std::ptrdiff_t>(model.body(b).first));
    }
    values = std::move(now);
  };
  carry_over(state.position);
  carry_over(state.velocity);
  carry_over(state.acceleration);
  carry_over(state.force);
}

dynamics::State initial_state(const RunSetup& setup, const Model& model) {
  dynamics::State state;
  state.position.assign(model.coefficients, 0.0);
  state.velocity.assign(model.coefficients, 0.0);
  state.installed.assign(setup.staged_supports.size(), 0);
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    const std::vector<Vec2> identity = block.basis.identity();
    for (std::size_t k = 0; k < identity.size(); ++k) {
      state.position[block.first + 2 * k] = identity[k].x;
      state.position[block.first + 2 * k + 1] = identity[k].y;
    }
    if (block.fixed || b >= setup.properties.size()) continue;
    // v(X) = v₀ + ω × (X − c): coefficient 0 holds the mean, the others the turned identity.
    const BlockProperties& properties = setup.properties[b];
    state.velocity[block.first] = properties.velocity.x * std::sqrt(block.area);
    state.velocity[block.first + 1] = properties.velocity.y * std::sqrt(block.area);
    for (std::size_t k = 1; k < identity.size(); ++k) {
      state.velocity[block.first + 2 * k] = -properties.spin * identity[k].y;
      state.velocity[block.first + 2 * k + 1] = properties.spin * identity[k].x;
    }
  }
  for (const auto& coupling : model.couplings) {
    if (const dynamics::StagedSupports* supports = coupling->staged_supports()) supports->place(model, state);
  }
  return state;
}

}  // namespace keyblock::simulation
