#include "simulation/build_water.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <tuple>
#include <vector>

#include "core/index.h"
#include "coupling/joint_water.h"
#include "cutting/interfaces.h"
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

/// Per face: a water never reaches it.
std::vector<std::uint8_t> dry_faces(const RunSetup& setup, const Model& model, const Water& water,
                                    std::span<const int> laws, std::span<const WaterFace> faces) {
  const CutSides cut(setup);
  std::vector<std::uint8_t> dry;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::size_t v = at(faces[f].vertex);
    const bool is_dry = laws[f] >= first_set_law
                            ? water.dry_joints[at(laws[f] - first_set_law)]
                            : cut.has(model.reference[v], model.reference[at(model.surface.next[v])]);
    dry.push_back(is_dry ? 1 : 0);
  }
  return dry;
}

/// Faces of all edges, in the order of the vertices, and the law of the joint that each is a side of.
class WaterFaces {
 public:
  WaterFaces(const RunSetup& setup, const Model& model) : model_(model), of_edge_(model.reference.size()) {
    for (std::size_t e = 0; e < setup.excavations.size(); ++e) {
      for (const dynamics::WallFace& wall : wall_faces(setup, model, e))
        add({wall.vertex, wall.from, wall.to, static_cast<int>(e), false}, joint_along(wall.vertex));
    }
    add_interfaces(setup);
    for (std::size_t v = 0; v < of_edge_.size(); ++v) fill(v);
  }

  [[nodiscard]] const std::vector<WaterFace>& faces() const { return faces_; }
  [[nodiscard]] const std::vector<int>& laws() const { return laws_; }

 private:
  struct FaceOfEdge {
    WaterFace face;
    int law;
  };
  [[nodiscard]] int joint_along(int vertex) const { return model_.surface.joint[at(vertex)]; }

  /// What is taken stays as it is.
  void add(const WaterFace& face, int law) {
    std::vector<FaceOfEdge>& faces = of_edge_[at(face.vertex)];
    const bool is_taken = std::ranges::any_of(faces, [&](const FaceOfEdge& other) {
      return face.from < other.face.to && other.face.from < face.to;
    });
    if (!is_taken) faces.push_back({face, law});
  }

  /// Stretches along the other block of an interface, of each edge of the surface that is a piece of an edge of the polygon.
  void add_interfaces(const RunSetup& setup) {
    std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> number_of;
    for (std::size_t b = 0; b < setup.system.blocks.size() && !setup.system.interfaces.empty(); ++b) {
      const Polygon& polygon = setup.system.blocks[b].polygon;
      for (std::size_t r = 0; r < polygon.ring_count(); ++r)
        for (std::size_t k = 0; k < polygon.ring(r).size(); ++k)
          number_of.try_emplace({b, r, k}, number_of.size());
    }
    for (const cutting::InterfaceFace& face : cutting::interface_faces(setup.system)) {
      const Ring& ring = setup.system.blocks[face.block].polygon.ring(face.ring);
      const Vec2 start = ring[face.edge], along = ring[(face.edge + 1) % ring.size()] - start;
      const int edge = static_cast<int>(number_of.at({face.block, face.ring, face.edge}));
      for (std::size_t v = 0; v < of_edge_.size(); ++v) {
        if (model_.outline_edge[v] != edge) continue;
        const auto share = [&](std::size_t vertex) {
          return dot(model_.reference[vertex] - start, along) / squared_norm(along);
        };
        const double begin = share(v), length = share(at(model_.surface.next[v])) - begin;
        const double from = whole((face.from - begin) / length), to = whole((face.to - begin) / length);
        if (from < to) add({static_cast<int>(v), from, to, -1, false}, law_of_set(face.joint));
      }
    }
  }

  /// Within 0 and 1, and one of them where only rounding is between.
  static double whole(double share) {
    constexpr double nothing = 1e-9;
    return share < nothing ? 0.0 : share > 1.0 - nothing ? 1.0 : share;
  }

  /// What is left of an edge.
  void fill(std::size_t v) {
    const int vertex = static_cast<int>(v), joint = joint_along(vertex);
    const bool is_rock = model_.laws[at(joint)].fused;
    double end = 0.0;
    const auto put = [&](WaterFace face, int law) {
      face.is_rock = is_rock;
      faces_.push_back(face);
      laws_.push_back(law);
    };
    std::ranges::sort(of_edge_[v], {}, [](const FaceOfEdge& one) { return one.face.from; });
    for (const FaceOfEdge& one : of_edge_[v]) {
      if (one.face.from > end) put({vertex, end, one.face.from, -1, false}, joint);
      put(one.face, one.law);
      end = one.face.to;
    }
    if (end < 1.0) put({vertex, end, 1.0, -1, false}, joint);
  }

  const Model& model_;
  std::vector<std::vector<FaceOfEdge>> of_edge_;
  std::vector<WaterFace> faces_;
  std::vector<int> laws_;
};

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
  const WaterFaces faces(setup, model);
  std::vector<dynamics::Water> waters;
  // Down along y: so the pressure of a table that is normal to gravity is that of water at rest, whichever way gravity points.
  for (const Water& water : setup.waters)
    waters.push_back({water.name, water.table, -water.density * setup.gravity.y,
                      dry_faces(setup, model, water, faces.laws(), faces.faces())});
  return std::make_shared<dynamics::JointWater>(std::move(waters), faces.faces(), openings(setup),
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
