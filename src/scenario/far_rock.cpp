#include "scenario/far_rock.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "loading/motion_measures.h"
#include "rockmass/section.h"
#include "scenario/key_path.h"
#include "scenario/magnitudes.h"
#include "simulation/build_boundary.h"

namespace keyblock::scenario {
namespace {

using simulation::Sides;

/// Symmetric: xx, yy, xy.
using Matrix = std::array<std::array<double, 3>, 3>;

Matrix compliance_of(const RockKeys& rock) {
  const bool strain = *rock.state == PlaneState::plane_strain;
  const double nu = *rock.poisson, young = strain ? *rock.young / (1.0 - nu * nu) : *rock.young,
               in_section = strain ? nu / (1.0 - nu) : nu, shear = 2.0 * (1.0 + nu) / *rock.young;
  return {
      {{1.0 / young, -in_section / young, 0.0}, {-in_section / young, 1.0 / young, 0.0}, {0.0, 0.0, shear}}};
}

void add_set(const rockmass::JointSet& set, const JointProperties& joint, double azimuth, double stiffness,
             Matrix& compliance) {
  const bool is_true = set.spacing_measure == rockmass::SpacingMeasure::true_spacing;
  const double distance =
                   set.spacing.mean *
                   (is_true ? rockmass::trace_spacing_factor(set.dip, set.dip_direction, azimuth) : 1.0),
               density = set.length.mean / (set.length.mean + set.gap.mean) / distance,
               fall = rockmass::radians(rockmass::apparent_dip(set.dip, set.dip_direction, azimuth)),
               nx = std::sin(fall), ny = std::cos(fall), normal = joint.normal_stiffness.value_or(stiffness),
               shear = joint.stiffness_ratio * normal;
  const std::array<double, 3> across{nx * nx, ny * ny, 2.0 * nx * ny},
      along{-nx * ny, nx * ny, nx * nx - ny * ny};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c)
      compliance[r][c] += density * (across[r] * across[c] / normal + along[r] * along[c] / shear);
  }
}

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

void warn_of_motion(const Scenario& scenario, const simulation::RunSetup& setup,
                    const simulation::Stage& stage, std::vector<std::string>& warnings) {
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

}  // namespace

dynamics::RockLayer effective_rock(const Scenario& scenario, const simulation::JointTable& joints) {
  const RockKeys& rock = scenario.rock;
  Matrix s = compliance_of(rock);
  const double stiffness = scenario.solver.penalty * *rock.young;
  for (std::size_t k = 0; k < scenario.joint_sets.size(); ++k)
    add_set(scenario.joint_sets[k].set, joints.joint_sets[k], scenario.section_azimuth.value_or(0.0),
            stiffness, s);
  const auto minor = [&](std::size_t r1, std::size_t r2, std::size_t c1, std::size_t c2) {
    return s[r1][c1] * s[r2][c2] - s[r1][c2] * s[r2][c1];
  };
  const double determinant =
      s[0][0] * minor(1, 2, 1, 2) - s[0][1] * minor(1, 2, 0, 2) + s[0][2] * minor(1, 2, 0, 1);
  return {.density = *rock.density,
          .shear = minor(0, 1, 0, 1) / determinant,
          .upright = minor(0, 2, 0, 2) / determinant,
          .sideways = -minor(0, 2, 1, 2) / determinant};
}

std::optional<simulation::Boundary> boundary_of(const Scenario& scenario,
                                                const simulation::JointTable& joints, double origin) {
  if (!scenario.boundary || scenario.boundary->sides == Sides::frame) return std::nullopt;
  const BoundarySpec& spec = *scenario.boundary;
  simulation::Boundary boundary;
  boundary.compliant = spec.compliant;
  boundary.sides = spec.sides;
  boundary.overburden = spec.overburden;
  if (spec.overburden) boundary.depth = scenario.in_situ ? scenario.in_situ->depth.value_or(0.0) : 0.0;
  for (const RockLayerSpec& layer : spec.column)
    boundary.layers.push_back(layer_of(layer.top - origin, layer.density, layer.vs, layer.vp));
  if (boundary.layers.empty()) boundary.layers.push_back(effective_rock(scenario, joints));
  const dynamics::RockLayer& lowest = boundary.layers.back();
  const double density = spec.density.value_or(lowest.density);
  boundary.dashpots = {density * spec.vs.value_or(lowest.speeds().x),
                       density * spec.vp.value_or(lowest.speeds().y)};
  boundary.fastest = spec.frequency;
  return boundary;
}

void take_to_outcrop(const Scenario& scenario, std::vector<loading::GroundMotion>& motions) {
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (scenario.motions[k].place != MotionPlace::inside) continue;
    std::vector<Vec2> twice = motions[k].accelerations();
    for (Vec2& a : twice) a = 2.0 * a;
    motions[k] = loading::GroundMotion(motions[k].name(), motions[k].times(), std::move(twice));
  }
}

std::vector<std::pair<std::string, std::string>> boundary_facts(const simulation::Boundary& boundary,
                                                                double origin) {
  std::vector<std::pair<std::string, std::string>> facts;
  const char* sides = boundary.sides == Sides::free_field ? "free field"
                      : boundary.sides == Sides::viscous  ? "viscous"
                                                          : "rollers";
  facts.emplace_back("boundary",
                     fmt::format("{} base, {} at the sides, {}", boundary.compliant ? "compliant" : "rigid",
                                 sides, boundary.overburden ? "overburden" : "free top"));
  if (boundary.compliant)
    facts.emplace_back("impedance of the half-space", fmt::format("ρ v_s {:.4g}, ρ v_p {:.4g} Pa s/m",
                                                                  boundary.dashpots.x, boundary.dashpots.y));
  for (const dynamics::RockLayer& layer : boundary.layers) {
    const std::string from =
        boundary.layers.size() > 1 ? fmt::format(" below {:.4g} m", layer.top + origin) : "";
    facts.emplace_back("rock beside the model" + from,
                       fmt::format("v_s {:.4g} m/s, v_p {:.4g} m/s, {:.4g} kg/m³", layer.speeds().x,
                                   layer.speeds().y, layer.density));
  }
  return facts;
}

void add_boundary_warnings(const Scenario& scenario, const simulation::RunSetup& setup,
                           std::vector<std::string>& warnings) {
  if (!setup.boundary) return;
  for (const simulation::Stage& stage : setup.stages) {
    if (stage.kind == simulation::StageKind::shake) warn_of_motion(scenario, setup, stage, warnings);
  }
}

}  // namespace keyblock::scenario
