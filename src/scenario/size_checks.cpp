#include "scenario/size_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "scenario/key_path.h"
#include "scenario/magnitudes.h"
#include "simulation/rock_sample.h"

namespace keyblock::scenario {
namespace {

using record::Stage;
using simulation::RunSetup;

/// Of the mean size of blocks: what moves farther has come out of its place, and what moves less has not moved.
constexpr double most_way = 0.5, least_way = 1e-5;
/// Of the size of the model, by which one side of a slope is higher.
constexpr double least_slope = 0.1;
/// Of the width of the model, from its ends, where the ground is looked at.
constexpr double inset = 0.02;

/// "; was it in mm? That is 0.001 m", for what is most_way too large.
std::string unit_of_way(double way, double size) {
  constexpr double likely = 0.1, least_likely = 1e-4;
  for (const auto& [name, factor] : {std::pair{"cm", 1e-2}, std::pair{"mm", 1e-3}})
    if (const double meant = way * factor; meant <= likely * size && meant >= least_likely * size)
      return fmt::format("; was it in {}? That is {:.4g} m", name, meant);
  return {};
}

void warn_of_damage(const Scenario& scenario, const RunSetup& setup, std::vector<std::string>& warnings) {
  const double size = simulation::mean_block_size(setup);
  const std::pair<const char*, double> limits[] = {
      {"damage.loosened_distance", scenario.damage.loosened_distance},
      {"damage.slip", scenario.damage.slip},
      {"damage.opening", scenario.damage.opening}};
  for (const auto& [key, way] : limits) {
    if (!scenario.positions.contains(key) || is_unusual(scenario, key)) continue;
    if (way > most_way * size)
      warnings.push_back(
          fmt::format("{} = {:.4g} m{}: blocks are {:.2g} m, and nothing counts before it has "
                      "left its place{}",
                      key, way, place_text(scenario, key), size, unit_of_way(way, size)));
    if (way < least_way * size)
      warnings.push_back(
          fmt::format("{} = {:.4g} m{}: blocks are {:.2g} m, and all count that bend or settle; "
                      "usual is at least {:.2g} m",
                      key, way, place_text(scenario, key), size, least_way * size));
  }
}

/// m, the highest rock above a place; none where there is nothing.
std::optional<double> height_at(const RunSetup& setup, double x, const std::vector<bool>& is_out) {
  std::optional<double> height;
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    if (is_out[b]) continue;
    const Ring& ring = setup.system.blocks[b].polygon.outer;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 p = ring[k], q = ring[(k + 1) % ring.size()];
      if (p.x == q.x || std::min(p.x, q.x) > x || std::max(p.x, q.x) < x) continue;
      const double y = std::lerp(p.y, q.y, (x - p.x) / (q.x - p.x));
      height = std::max(height.value_or(y), y);
    }
  }
  return height;
}

/// 1: the ground falls to the right; -1: to the left; 0: neither, after what has been taken out.
int side_of_slope(const RunSetup& setup, const std::vector<bool>& is_out) {
  Box box;
  for (const cutting::CutBlock& block : setup.system.blocks)
    for (const Vec2 p : block.polygon.outer) box.add(p);
  const double width = box.size().x;
  const auto left = height_at(setup, box.min.x + inset * width, is_out),
             right = height_at(setup, box.max.x - inset * width, is_out);
  if (!left || !right || std::abs(*left - *right) <= least_slope * std::max(width, box.size().y)) return 0;
  return *left > *right ? 1 : -1;
}

/// Blocks that a stage excavates.
void take_out(const RunSetup& setup, const Stage& stage, std::vector<bool>& is_out) {
  for (std::size_t b = 0; b < is_out.size(); ++b) {
    const std::vector<int>& excavations = setup.system.blocks[b].excavations;
    is_out[b] = is_out[b] || std::ranges::find_first_of(excavations, stage.excavate) != excavations.end();
  }
}

void warn_of_push(const Scenario& scenario, const std::string& key, double push, int slope, double value,
                  std::vector<std::string>& warnings) {
  if (push * slope >= 0.0) return;
  warnings.push_back(
      fmt::format("{} = {:.4g}{}: pushes to the {}, into the slope, which falls to the {}; {:.4g} "
                  "pushes out of it",
                  key, value, place_text(scenario, key), push > 0.0 ? "right" : "left",
                  slope > 0 ? "right" : "left", -value));
}

void warn_of_direction(const Scenario& scenario, const RunSetup& setup, std::vector<std::string>& warnings) {
  std::vector<bool> is_out(setup.system.blocks.size(), false);
  int slope = 0;
  for (const Stage& stage : setup.stages) {
    take_out(setup, stage, is_out);
    slope = side_of_slope(setup, is_out);
    warn_of_push(scenario, join_path(join_path("stage", stage.name), "k_h"), stage.k_h, slope, stage.k_h,
                 warnings);
  }
  if (scenario.tilt != 0.0) warn_of_push(scenario, "tilt", -scenario.tilt, slope, scenario.tilt, warnings);
}

}  // namespace

int side_of_slope(const simulation::RunSetup& setup) {
  std::vector<bool> is_out(setup.system.blocks.size(), false);
  for (const Stage& stage : setup.stages) take_out(setup, stage, is_out);
  return side_of_slope(setup, is_out);
}

void add_size_warnings(const Scenario& scenario, const RunSetup& setup, std::vector<std::string>& warnings) {
  if (scenario.si_units) warn_of_damage(scenario, setup, warnings);
  if (!scenario.accepted.direction) warn_of_direction(scenario, setup, warnings);
}

}  // namespace keyblock::scenario
