#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "scenario/sections.h"
#include "study/plan.h"

namespace keyblock::study {

using scenario::Scenario;

MapGrid map_grid(const Scenario& scenario) {
  const Box model = scenario::box_of_model(scenario);
  Box box;
  for (const scenario::ExcavationSpec& spec : scenario.excavations) {
    for (const Vec2 p : scenario::excavation_outline(spec)) box.add(p);
  }
  double cell = 0.0;
  if (scenario.excavations.empty()) {
    box = model;
    cell = std::max(box.size().x, box.size().y) / 80.0;
  } else {
    Box opening;
    for (const Vec2 p : scenario::excavation_outline(scenario.excavations.front())) opening.add(p);
    const double width = opening.size().x;
    box = {box.min - Vec2{width, width}, box.max + Vec2{width, width}};
    box.min = {std::max(box.min.x, model.min.x), std::max(box.min.y, model.min.y)};
    box.max = {std::min(box.max.x, model.max.x), std::min(box.max.y, model.max.y)};
    cell = width / 40.0;
  }
  if (scenario.study && scenario.study->map_cell) cell = *scenario.study->map_cell;
  const Vec2 size = box.size();
  if (!(cell > 0.0) || !(size.x > 0.0) || !(size.y > 0.0)) return {};
  if (size.x / cell * (size.y / cell) > most_cells) {
    throw InputError(Diagnostic{scenario.where("study.map.cell"), "study.map.cell",
                                fmt::format("{:.2g} cells", size.x / cell * (size.y / cell)),
                                fmt::format("at most {:.0e} cells", most_cells), ""});
  }
  return {box.min, cell, static_cast<int>(std::ceil(size.x / cell - 1e-9)),
          static_cast<int>(std::ceil(size.y / cell - 1e-9))};
}

std::vector<DamageLevel> damage_levels(const Scenario& scenario) {
  std::vector<DamageLevel> levels;
  if (scenario.study) {
    for (const scenario::LevelSpec& level : scenario.study->levels)
      levels.push_back({level.name, level.measure, level.threshold});
  }
  if (!levels.empty()) return levels;
  double area = 0.0;
  for (const scenario::ExcavationSpec& spec : scenario.excavations)
    area += std::abs(signed_area(scenario::excavation_outline(spec)));
  if (area == 0.0) return {{"any", "fallen_blocks", 0.0}};
  return {{"light", "fallen_area_m2", 0.002 * area},
          {"moderate", "fallen_area_m2", 0.02 * area},
          {"severe", "fallen_area_m2", 0.1 * area}};
}

}  // namespace keyblock::study
