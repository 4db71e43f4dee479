#include "simulation/bolt_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/elements.h"
#include "simulation/refuse.h"
#include "simulation/runner.h"
#include "simulation/setup.h"

namespace keyblock::simulation {

namespace {

constexpr double rigid_young = 1e13;        // Pa
constexpr double light_density = 1.0;       // kg/m³, so that to move the block takes no force
constexpr double gap_share = 1e-6;          // of the length, between the blocks: they do not touch
constexpr double held_stiffly = 1e4;        // times the stiffest spring of the bolt
constexpr double duration = 2.0;            // s
constexpr double nearest_to_an_end = 1e-3;  // of the length

void add_block(RunSetup& setup, const char* name, double bottom, double top, double half_width, bool fixed) {
  cutting::CutBlock block;
  block.polygon.outer = {{-half_width, bottom}, {half_width, bottom}, {half_width, top}, {-half_width, top}};
  block.labels.emplace_back(block.polygon.outer.size());
  setup.system.blocks.push_back(std::move(block));
  BlockProperties properties;
  properties.name = name;
  properties.material = {light_density, rigid_young, 0.2, block::PlaneState::plane_stress};
  properties.fixed = fixed;
  setup.properties.push_back(std::move(properties));
}

/// Holds the block of the head in one direction, by points far apart.
void add_support(RunSetup& setup, const BoltBench& bench, double half_width, double stiffness, bool along_x) {
  loading::Support support;
  support.name = along_x ? "x" : "y";
  support.block = "head";
  support.points = {{-0.9 * half_width, 0.5 * bench.at}, {0.9 * half_width, 0.5 * bench.at}};
  support.along_x = along_x;
  support.along_y = !along_x;
  support.stiffness = stiffness;
  if (along_x == bench.is_shear) {
    // The head is at the bottom: it goes down as the joint opens.
    const loading::TimeTable way({{0.0, 0.0}, {duration, bench.is_shear ? bench.way : -bench.way}});
    (along_x ? support.motion_x : support.motion_y) = way;
  }
  setup.supports.push_back(std::move(support));
}

RunSetup setup_of(const loading::Bolt& bolt, const BoltBench& bench) {
  const double length = bolt.length();
  if (!(bench.at > nearest_to_an_end * length) || !(bench.at < (1.0 - nearest_to_an_end) * length))
    refuse("at", fmt::format("{:.6g} m", bench.at),
           fmt::format("a joint that the bolt crosses, from 0 to {:.6g} m from its head", length));
  RunSetup setup;
  add_block(setup, "head", 0.0, bench.at - gap_share * length, length, false);
  add_block(setup, "toe", bench.at, 1.5 * length, length, true);
  loading::Bolt here = bolt;
  here.name = here.list = "bolt";
  here.head = {};
  here.toe = {0.0, length};
  here.spacing = 1.0;
  here.pretension = 0.0;
  here.staged = -1;
  setup.bolts = {std::move(here)};
  const double stiffness = held_stiffly * (bolt.bar() / std::min(bolt.active_length, length) +
                                           bolt.dowel_stiffness + bolt.grout_stiffness * length);
  for (const bool along_x : {true, false}) add_support(setup, bench, length, stiffness, along_x);
  setup.gravity = {};
  setup.solver.theta = 0.0;  // what is moved at an even speed does not swing
  setup.time_step = duration / bench.steps;
  record::Stage move;
  move.name = "move";
  move.kind = record::StageKind::rest;
  move.duration = duration;
  setup.stages = {std::move(move)};
  return setup;
}

}  // namespace

double BoltCurve::largest() const {
  return force.empty() ? 0.0 : *std::ranges::max_element(force);
}

double BoltCurve::force_at(double place) const {
  const auto next = std::ranges::lower_bound(displacement, place);
  if (next == displacement.begin()) return force.front();
  if (next == displacement.end()) return force.back();
  const std::size_t k = static_cast<std::size_t>(next - displacement.begin());
  const double share = (place - displacement[k - 1]) / (displacement[k] - displacement[k - 1]);
  return force[k - 1] + share * (force[k] - force[k - 1]);
}

BoltCurve test_bolt(const loading::Bolt& bolt, const BoltBench& bench) {
  const RunSetup setup = setup_of(bolt, bench);
  record::RunObserver nobody;
  Runner runner(setup, {}, nobody);
  BoltCurve curve{{0.0}, {0.0}};
  const std::size_t moved = bench.is_shear ? 0 : 1;  // supports are the first elements
  while (!runner.done()) {
    if (!runner.advance().took_step) continue;
    curve.displacement.push_back(bench.way * std::min(runner.state().time / duration, 1.0));
    curve.force.push_back(element_states(runner.model(), runner.state())[moved].force);
  }
  return curve;
}

}  // namespace keyblock::simulation
