#include "scenario/liners.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenario/bolts.h"
#include "scenario/key_path.h"
#include "simulation/build_liners.h"

namespace keyblock::scenario {
namespace {

// Of its length: rock on the side of the opening; wall without rock that is worth a word. Of the radius of the opening: thickness. Stations.
constexpr double most_inside = 0.5, odd_gap = 0.1, most_of_radius = 1.0 / 3.0;
constexpr std::size_t many_stations = 500;

[[noreturn]] void refuse_liner(const Scenario& scenario, const LinerSpec& spec, const char* key,
                               std::string found, std::string expected) {
  const std::string path = join_path(join_path("liner", spec.liner.name), key);
  throw InputError(Diagnostic{scenario.where(path), path, std::move(found), std::move(expected), ""});
}

double length_of_wall(const loading::Liner& liner) {
  double length = liner.is_closed ? norm(liner.wall.front() - liner.wall.back()) : 0.0;
  for (std::size_t k = 1; k < liner.wall.size(); ++k) length += norm(liner.wall[k] - liner.wall[k - 1]);
  return length;
}

/// Whether a stage excavates the opening after the liner is there, or no stage does.
bool comes_before_its_opening(const simulation::RunSetup& setup, const loading::Liner& liner,
                              int excavation) {
  for (const record::Stage& stage : setup.stages) {
    if (std::ranges::find(stage.excavate, excavation) != stage.excavate.end()) return liner.staged < 0;
    if (std::ranges::find(stage.install, liner.name) != stage.install.end()) return true;
  }
  return true;
}

std::vector<Vec2> along_outline(const Scenario& scenario, const LinerSpec& spec, const Ring& outline) {
  std::vector<Vec2> wall;
  for (const auto& [from, to] : sides_of(spec.arc, outline)) {
    if (wall.empty() || !(norm(wall.back() - from) < 1e-9 * norm(to - from))) wall.push_back(from);
    wall.push_back(to);
  }
  if (wall.empty())
    refuse_liner(scenario, spec, "arc", "an arc without a part of the outline",
                 "angles that have some of the outline between them");
  if (!spec.arc) wall.pop_back();
  return wall;
}

}  // namespace

std::vector<loading::Liner> liners_of(const Scenario& scenario, const std::vector<Ring>& outlines) {
  std::vector<loading::Liner> liners;
  for (const LinerSpec& spec : scenario.liners) {
    loading::Liner& liner = liners.emplace_back(spec.liner);
    liner.is_plane_strain = scenario.rock.state == block::PlaneState::plane_strain;
    if (spec.excavation < 0) continue;
    const Ring& outline = outlines[static_cast<std::size_t>(spec.excavation)];
    liner.wall = along_outline(scenario, spec, outline);
    liner.is_closed = !spec.arc;
    const double radius = std::sqrt(area({outline, {}}) / 3.14159265358979);
    if (liner.thickness > most_of_radius * radius)
      refuse_liner(
          scenario, spec, "thickness", fmt::format("{} m", liner.thickness),
          fmt::format("a third of the radius of the opening at the most, {:.3g} m", most_of_radius * radius));
  }
  return liners;
}

void check_liners(const Scenario& scenario, simulation::RunSetup& setup, std::vector<std::string>& warnings) {
  for (std::size_t k = 0; k < setup.liners.size(); ++k) {
    const LinerSpec& spec = scenario.liners[k];
    loading::Liner& liner = setup.liners[k];
    const std::string path = join_path("liner", liner.name);
    const char* key = spec.excavation >= 0 ? "excavation" : "points";
    if (spec.excavation >= 0 && comes_before_its_opening(setup, liner, spec.excavation))
      refuse_liner(scenario, spec, key, "a liner that is there before the opening is excavated",
                   "the liner in `install` of the stage that excavates it, or of a later one");
    loading::Liner other = liner;
    std::ranges::reverse(other.wall);
    double rock = simulation::rock_beside(setup, liner), inside = simulation::rock_beside(setup, other);
    if (spec.excavation < 0 && inside > rock) {
      liner = other;
      std::swap(rock, inside);
    }
    const double length = length_of_wall(liner);
    if (rock <= 0.0)
      refuse_liner(scenario, spec, key, "a line beside which there is no rock when the liner is installed",
                   "the wall of an opening");
    if (inside > most_inside * length)
      refuse_liner(scenario, spec, key, "a line with rock on both sides when the liner is installed",
                   "the wall of an opening");
    if (rock < (1.0 - odd_gap) * length)
      warnings.push_back(fmt::format("{}: {:.3g} of its {:.3g} m lie on no rock; it spans them", path,
                                     length - rock, length));
    if (!liner.strength())
      warnings.push_back(fmt::format(
          "{}: has no compressive_strength and tensile_strength, so that nothing says whether it holds",
          path));
    if (const std::size_t stations = simulation::liner_cells(setup, k).size(); stations > many_stations)
      warnings.push_back(
          fmt::format("{}: has {} stations, which makes steps slow; a larger element_length takes less time",
                      path, stations));
  }
}

}  // namespace keyblock::scenario
