#include "simulation/build_water.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"
#include "coupling/joint_water.h"
#include "simulation/build_boundary.h"
#include "simulation/joint_laws.h"
#include "simulation/wall_faces.h"

namespace keyblock::simulation {

namespace {

using dynamics::Model;
using dynamics::WaterFace;

/// Of the size of the model: what rounding makes of one place.
constexpr double same_place = 1e-9;

/// Whether an edge is where the model is cut out of the rock, which goes on behind it: along the frame, or at the base and the sides of a
/// boundary. There is no joint there, and no water.
class CutSides {
 public:
  explicit CutSides(const RunSetup& setup)
      : setup_(setup),
        box_(boundary_box(setup)),
        tolerance_(same_place * std::max(box_.size().x, box_.size().y)) {}

  [[nodiscard]] bool has(Vec2 from, Vec2 to) const {
    if (!setup_.frame && !setup_.boundary) return false;
    const auto both = [&](double Vec2::*coordinate, double place) {
      return std::abs(from.*coordinate - place) <= tolerance_ &&
             std::abs(to.*coordinate - place) <= tolerance_;
    };
    return both(&Vec2::x, box_.min.x) || both(&Vec2::x, box_.max.x) || both(&Vec2::y, box_.min.y) ||
           (setup_.frame && both(&Vec2::y, box_.max.y));
  }

 private:
  const RunSetup& setup_;
  Box box_;
  double tolerance_;
};

/// Per edge of the surface: a water never reaches it.
std::vector<std::uint8_t> dry_edges(const RunSetup& setup, const Model& model, const Water& water) {
  const CutSides cut(setup);
  std::vector<std::uint8_t> dry;
  for (std::size_t v = 0; v < model.reference.size(); ++v) {
    const std::optional<std::size_t> set = set_of_law(setup, at(model.surface.joint[v]));
    const bool is_dry = set ? water.dry_joints[*set]
                            : cut.has(model.reference[v], model.reference[at(model.surface.next[v])]);
    dry.push_back(is_dry ? 1 : 0);
  }
  return dry;
}

/// Faces of all edges: those along the outlines of excavations, and what is left between them.
std::vector<WaterFace> water_faces(const RunSetup& setup, const Model& model) {
  std::vector<std::vector<WaterFace>> of_edge(model.reference.size());
  for (std::size_t e = 0; e < setup.excavations.size(); ++e) {
    for (const dynamics::WallFace& wall : wall_faces(setup, model, e)) {
      std::vector<WaterFace>& faces = of_edge[at(wall.vertex)];
      const bool is_taken = std::ranges::any_of(
          faces, [&](const WaterFace& face) { return wall.from < face.to && face.from < wall.to; });
      if (!is_taken) faces.push_back({wall.vertex, wall.from, wall.to, static_cast<int>(e), false});
    }
  }
  std::vector<WaterFace> all;
  for (std::size_t v = 0; v < of_edge.size(); ++v) {
    const bool is_rock = model.laws[at(model.surface.joint[v])].fused;
    const std::size_t first = all.size();
    double end = 0.0;
    std::ranges::sort(of_edge[v], {}, &WaterFace::from);
    for (const WaterFace& wall : of_edge[v]) {
      if (wall.from > end) all.push_back({static_cast<int>(v), end, wall.from, -1, false});
      all.push_back(wall);
      end = wall.to;
    }
    if (end < 1.0) all.push_back({static_cast<int>(v), end, 1.0, -1, false});
    for (std::size_t f = first; f < all.size(); ++f) all[f].is_rock = is_rock;
  }
  return all;
}

std::vector<dynamics::WaterOpening> openings(const RunSetup& setup) {
  std::vector<dynamics::WaterOpening> all;
  for (const Excavation& excavation : setup.excavations) all.push_back({{}, excavation.is_filled});
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    for (const int e : setup.system.blocks[b].excavations) all[at(e)].inside.push_back(static_cast<int>(b));
  }
  return all;
}

/// Shown from its leftmost vertex to its rightmost one. block: −1: all that move.
dynamics::WateredBlock watered(const Model& model, std::string name, int block) {
  const contact::Surface& surface = model.surface;
  dynamics::WateredBlock shown;
  shown.name = std::move(name);
  shown.block = block;
  shown.from = -1;
  for (int v = 0; v < surface.vertices(); ++v) {
    const int b = surface.block[at(v)];
    if (block >= 0 ? b != block : surface.fixed[at(b)] != 0) continue;
    if (shown.from < 0) shown.from = shown.to = v;
    if (model.reference[at(v)].x < model.reference[at(shown.from)].x) shown.from = v;
    if (model.reference[at(v)].x > model.reference[at(shown.to)].x) shown.to = v;
  }
  if (shown.from < 0) shown.from = shown.to = 0;
  shown.from_end = {model.reference[at(shown.from)], surface.block[at(shown.from)]};
  shown.to_end = {model.reference[at(shown.to)], surface.block[at(shown.to)]};
  return shown;
}

std::vector<dynamics::WateredBlock> watered_blocks(const RunSetup& setup, const Model& model) {
  std::vector<dynamics::WateredBlock> all{watered(model, "water", -1)};
  for (std::size_t b = 0; b < setup.properties.size(); ++b) {
    const BlockProperties& properties = setup.properties[b];
    if (!properties.name.empty() && !properties.fixed)
      all.push_back(watered(model, "water." + properties.name, static_cast<int>(b)));
  }
  return all;
}

}  // namespace

std::shared_ptr<const dynamics::Coupling> joint_water(const RunSetup& setup, const Model& model) {
  if (setup.waters.empty()) return nullptr;
  std::vector<dynamics::Water> waters;
  // Down along y: so the pressure of a table that is normal to gravity is that of water at rest, whichever way gravity points.
  for (const Water& water : setup.waters)
    waters.push_back(
        {water.name, water.table, -water.density * setup.gravity.y, dry_edges(setup, model, water)});
  return std::make_shared<dynamics::JointWater>(std::move(waters), water_faces(setup, model), openings(setup),
                                                watered_blocks(setup, model), model.surface, model.reference);
}

std::optional<record::WaterRecord> water_record(const Model& model, const dynamics::State& state) {
  const dynamics::WaterOfModel water = dynamics::water_of(model, state);
  if (water.water == nullptr) return std::nullopt;
  dynamics::WaterTotals totals = water.water->totals(model, state, water.memory);
  if (!totals.acts) return std::nullopt;
  return record::WaterRecord{std::move(totals.name), totals.largest_pressure, totals.wet, totals.drained,
                             std::move(totals.forces)};
}

int water_in(const RunSetup& setup, std::size_t k) {
  int now = setup.waters.empty() ? -1 : 0;
  for (std::size_t s = 0; s <= k && s < setup.stages.size(); ++s) now = setup.stages[s].water.value_or(now);
  return now;
}

}  // namespace keyblock::simulation
