#include "scenario/far_rock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "loading/motion_measures.h"
#include "scenario/key_path.h"
#include "scenario/magnitudes.h"
#include "simulation/build_boundary.h"
#include "simulation/far_layers.h"
#include "simulation/far_planes.h"

namespace keyblock::scenario {
namespace {

using record::Sides;

dynamics::RockLayer layer_of(double top, double density, double vs, double vp) {
  const double shear = density * vs * vs, upright = density * vp * vp;
  return {top, density, shear, upright, upright - 2.0 * shear};
}

/// m/s, of the base at the end of a motion.
Vec2 last_velocity(const loading::GroundMotion& motion) {
  const double duration = motion.duration();
  return duration > 0.0 ? duration * motion.mean(0.0, duration) : Vec2{};
}

bool shakes_sideways(const loading::GroundMotion& motion) {
  return std::any_of(motion.accelerations().begin(), motion.accelerations().end(),
                     [](Vec2 a) { return a.x != 0.0; });
}

const char* name_of(simulation::ColumnSide side) {
  return side == simulation::ColumnSide::left ? "left" : "right";
}

void add_layer_facts(const std::vector<dynamics::RockLayer>& layers, double origin, const char* where,
                     std::vector<std::pair<std::string, std::string>>& facts) {
  for (const dynamics::RockLayer& layer : layers) {
    const std::string from = layers.size() > 1 ? fmt::format(" below {:.4g} m", layer.top + origin) : "";
    facts.emplace_back(where + from, fmt::format("v_s {:.4g} m/s, v_p {:.4g} m/s, {:.4g} kg/m³",
                                                 layer.speeds().x, layer.speeds().y, layer.density));
  }
}

/// "2.3 of its strength"
std::string asked_for(double mobilized) {
  return std::isfinite(mobilized) ? fmt::format("{:.2g} of its strength", mobilized)
                                  : "more than any strength";
}

/// Blocks belong to a region by their centroids. The layer beside the model ends where the region was drawn.
void to_outline(const Scenario& scenario, const simulation::RunSetup& setup, double& height) {
  constexpr double level = 0.1;  // rise of an edge over its length
  const double origin = setup.system.origin.y;
  double nearest = simulation::mean_block_size(setup), end = height;
  for (const RegionSpec& region : scenario.regions) {
    const Ring& outline = region.polygon.outer;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k], b = outline[(k + 1) % outline.size()];
      const double middle = 0.5 * (a.y + b.y) - origin;
      if (std::abs(b.y - a.y) > level * std::abs(b.x - a.x) || std::abs(middle - height) >= nearest) continue;
      nearest = std::abs(middle - height);
      end = middle;
    }
  }
  height = end;
}

/// The layers that [boundary] gives, or those of the model.
void place_layers(const Scenario& scenario, std::span<const simulation::JointPiece> pieces,
                  simulation::RunSetup& setup) {
  simulation::Boundary& boundary = *setup.boundary;
  boundary.layers.clear();
  for (const RockLayerSpec& layer : scenario.boundary->column)
    boundary.layers.push_back(layer_of(layer.top - setup.system.origin.y, layer.density, layer.vs, layer.vp));
  boundary.source = "[[boundary.column]]";
  if (!boundary.layers.empty()) return;
  simulation::FarLayers far = simulation::far_layers(setup, pieces);
  if (!far.gap.empty() || far.left.empty())
    throw InputError(
        Diagnostic{scenario.where("boundary"), "boundary",
                   fmt::format("no rock at the {}", far.gap.empty() ? "sides" : far.gap),
                   "blocks at the sides, or [[boundary.column]], which says what the rock there is", ""});
  for (auto* layers : {&far.left, &far.right}) {
    for (std::size_t k = 1; k < layers->size(); ++k) to_outline(scenario, setup, (*layers)[k].top);
  }
  boundary.layers = std::move(far.left);
  boundary.right_layers = std::move(far.right);
  boundary.source = std::move(far.source);
}

/// The layers, and the half-space below, which is as the lowest one but for what [boundary] says.
void take_layers(const Scenario& scenario, std::span<const simulation::JointPiece> pieces,
                 simulation::RunSetup& setup) {
  place_layers(scenario, pieces, setup);
  const dynamics::RockLayer& lowest = setup.boundary->layers.back();
  const BoundarySpec& spec = *scenario.boundary;
  const double density = spec.density.value_or(lowest.density);
  setup.boundary->dashpots = {density * spec.vs.value_or(lowest.speeds().x),
                              density * spec.vp.value_or(lowest.speeds().y)};
}

void warn_of_motion(const Scenario& scenario, const simulation::RunSetup& setup, const record::Stage& stage,
                    std::vector<std::string>& warnings) {
  constexpr double most_drift = 1e-3;    // m, of one end of the model against the other
  constexpr double least_blocks = 10.0;  // in the length of a wave
  const simulation::Boundary& boundary = *setup.boundary;
  const loading::GroundMotion& motion = setup.motions[static_cast<std::size_t>(stage.motion)];
  const std::string& path = scenario.motions[static_cast<std::size_t>(stage.motion)].path;
  const dynamics::RockLayer& rock = boundary.layers.front();
  const double vs = rock.speeds().x, height = simulation::boundary_box(setup).size().y;
  if (const double drift = stage.scale * norm(last_velocity(motion)) * height / vs; drift > most_drift)
    warnings.push_back(fmt::format(
        "{}: the velocity does not come back to zero; the rock stays sheared by {:.2g} m over its height; "
        "baseline = \"linear\" takes that off",
        path, drift));
  if (boundary.sides == Sides::viscous)
    warnings.push_back(
        fmt::format("boundary.sides{} = \"viscous\": rock at rest beside a model that {} shakes; even "
                    "ground does not move as one; \"free-field\" sides move with it",
                    place_text(scenario, "boundary.sides"), join_path("stage", stage.name)));
  if (boundary.sides == Sides::roller && shakes_sideways(motion))
    warnings.push_back(
        fmt::format("boundary.sides{} = \"roller\": no shear wave goes up between sides that are held "
                    "across, in {}; \"free-field\" sides move with it",
                    place_text(scenario, "boundary.sides"), join_path("stage", stage.name)));
  double area = 0.0;
  for (const cutting::CutBlock& block : setup.system.blocks) area += keyblock::area(block.polygon);
  const double size = std::sqrt(area / static_cast<double>(setup.system.blocks.size())),
               period = loading::mean_period(motion);
  if (period > 0.0 && size > vs * period / least_blocks)
    warnings.push_back(
        fmt::format("{}: a wave of its mean period, {:.3g} s, is {:.3g} m long, which is {:.2g} blocks; "
                    "usual is at least {}",
                    path, period, vs * period, vs * period / size, least_blocks));
}

/// Without a domain the base is where the lowest edges lie: what is a little higher stands on nothing.
void warn_of_base(const simulation::RunSetup& setup, std::vector<std::string>& warnings) {
  constexpr double near = 0.02, alike = 1e-9;  // of the height, of the size
  const Box box = simulation::boundary_box(setup);
  const double tolerance = alike * std::max(box.size().x, box.size().y), origin = setup.system.origin.y;
  std::size_t on_base = 0, above = 0;
  double gap = HUGE_VAL;
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    if (setup.properties[b].fixed) continue;
    const Ring& ring = setup.system.blocks[b].polygon.outer;
    double lowest = HUGE_VAL;
    for (const Vec2 p : ring) lowest = std::min(lowest, p.y - box.min.y);
    bool has_edge = false;
    for (std::size_t k = 0; k < ring.size(); ++k)
      has_edge |= std::max(ring[k].y, ring[(k + 1) % ring.size()].y) - box.min.y <= tolerance;
    if (has_edge) {
      ++on_base;
    } else if (lowest <= near * box.size().y) {
      ++above;
      gap = std::min(gap, lowest);
    }
  }
  if (above > 0)
    warnings.push_back(
        fmt::format("boundary: the base is at {:.6g} m, where {} of the blocks given one by one {} an edge; "
                    "{} more {} {:.2g} m "
                    "above it, or on a corner, and {} not held by it",
                    box.min.y + origin, on_base, on_base == 1 ? "has" : "have", above,
                    above == 1 ? "lies" : "lie", gap, above == 1 ? "is" : "are"));
}

}  // namespace

std::optional<simulation::Boundary> boundary_of(const Scenario& scenario) {
  if (!scenario.boundary || scenario.boundary->sides == Sides::frame) return std::nullopt;
  const BoundarySpec& spec = *scenario.boundary;
  simulation::Boundary boundary;
  boundary.compliant = spec.compliant;
  boundary.sides = spec.sides;
  boundary.overburden = spec.overburden;
  if (spec.overburden) boundary.depth = scenario.in_situ ? scenario.in_situ->depth.value_or(0.0) : 0.0;
  boundary.fastest = spec.frequency;
  return boundary;
}

std::vector<simulation::JointPiece> place_far_rock(const Scenario& scenario, simulation::RunSetup& setup) {
  if (!setup.boundary) return {};
  std::vector<simulation::JointPiece> pieces = simulation::joint_pieces(setup);
  take_layers(scenario, pieces, setup);
  return pieces;
}

void place_far_planes(const Scenario& scenario, simulation::RunSetup& setup,
                      std::span<const simulation::JointPiece> pieces, std::vector<std::string>& warnings) {
  if (!setup.boundary) return;
  simulation::FarJoints joints = simulation::far_joints(setup, pieces);
  const double origin = setup.system.origin.y;
  if (!scenario.boundary->planes) {
    for (const simulation::FarPlane& plane : joints.planes) {
      if (plane.mobilized > 1.0)
        warnings.push_back(
            fmt::format("boundary.planes{} = false: '{}' at {:.4g} m would slip in the ground alone, which "
                        "asks for {}; the rock beside the model does not slip, and holds it inside",
                        place_text(scenario, "boundary.planes"), plane.joint,
                        plane.at_side[0].height + origin, asked_for(plane.mobilized)));
    }
  } else if (!joints.planes.empty()) {
    setup.boundary->planes = std::move(joints.planes);
    // What is a plane is no part of the rock.
    take_layers(scenario, joints.others, setup);
  }
  for (const simulation::HeldJoint& joint : joints.held) {
    constexpr double near_slip = 0.8;
    if (joint.mobilized > near_slip)
      warnings.push_back(fmt::format(
          "boundary.sides{}: '{}', {:.0f} degrees steep, meets the {} side at {:.4g} m; the ground alone "
          "asks for {}. The rock beside the model does not slip on it, and holds what slips "
          "inside; let it end inside the model, or move the sides away",
          place_text(scenario, "boundary.sides"), joint.joint, std::abs(joint.dip), name_of(joint.side),
          joint.height + origin, asked_for(joint.mobilized)));
  }
}

std::vector<std::pair<std::string, std::string>> boundary_facts(const simulation::RunSetup& setup) {
  std::vector<std::pair<std::string, std::string>> facts;
  if (!setup.boundary) return facts;
  const simulation::Boundary& boundary = *setup.boundary;
  const double origin = setup.system.origin.y;
  if (boundary.overburden)
    facts.emplace_back(
        "overburden",
        boundary.depth > 0.0
            ? fmt::format(
                  "its weight, and {:.4g} m of rock in which waves from below go on to the ground and "
                  "come back; what the model sends up does not come back",
                  boundary.depth)
            : "its stress alone: waves from below come back from the top of the model as from the ground");
  if (boundary.compliant)
    facts.emplace_back("impedance of the half-space", fmt::format("ρ v_s {:.4g}, ρ v_p {:.4g} Pa s/m",
                                                                  boundary.dashpots.x, boundary.dashpots.y));
  add_layer_facts(boundary.layers, origin,
                  boundary.right_layers.empty() ? "rock beside the model" : "rock on the left", facts);
  add_layer_facts(boundary.right_layers, origin, "rock on the right", facts);
  facts.emplace_back("taken from", boundary.source);
  if (boundary.sides != Sides::roller) {
    const auto [base, left] = simulation::column_heights(setup, simulation::ColumnSide::left);
    const double right = simulation::column_heights(setup, simulation::ColumnSide::right).ground;
    facts.emplace_back("columns beside the model",
                       left == right ? fmt::format("{:.4g} to {:.4g} m", base + origin, left + origin)
                                     : fmt::format("{:.4g} to {:.4g} m on the left, to {:.4g} m on the right",
                                                   base + origin, left + origin, right + origin));
  }
  for (const simulation::FarPlane& plane : boundary.planes)
    facts.emplace_back(fmt::format("“{}” beside the model", plane.joint),
                       fmt::format("goes on at {:.4g} m, where elastic ground asks for {}{}",
                                   plane.at_side[0].height + origin, asked_for(plane.mobilized),
                                   plane.mobilized > 1.0 ? ": it slips there as well" : ""));
  return facts;
}

void add_boundary_warnings(const Scenario& scenario, const simulation::RunSetup& setup,
                           std::vector<std::string>& warnings) {
  if (!setup.boundary) return;
  if (!setup.has_domain) warn_of_base(setup, warnings);
  for (const record::Stage& stage : setup.stages) {
    if (stage.kind == record::StageKind::shake) warn_of_motion(scenario, setup, stage, warnings);
  }
}

}  // namespace keyblock::scenario
