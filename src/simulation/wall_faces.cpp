#include "simulation/wall_faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "contact/tolerances.h"
#include "core/index.h"
#include "record/fallen.h"
#include "simulation/openings.h"
#include "simulation/outline_arc.h"
#include "simulation/refuse.h"

namespace keyblock::simulation {

namespace {

/// Of an edge from a to b with rock on its left, where it lies on the outline, the rock being outside.
std::vector<Stretch> on_outline(Vec2 a, Vec2 b, const Ring& outline, const contact::Tolerances& tolerances) {
  const double length = norm(b - a);
  const Vec2 along = (b - a) / length;
  std::vector<Stretch> stretches;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 begin = outline[(k + 1) % outline.size()] - a, end = outline[k] - a;
    const double from = dot(along, begin), to = dot(along, end), step = to - from;
    const double first = std::max(from, 0.0), last = std::min(to, length);
    if (last - first <= tolerances.end_zone && last - first < 0.5 * length) continue;
    const auto is_on = [&](double x) {
      return std::abs(std::lerp(cross(along, begin), cross(along, end), (x - from) / step)) <=
             tolerances.activation;
    };
    if (is_on(first) && is_on(last)) stretches.emplace_back(first / length, last / length);
  }
  std::ranges::sort(stretches);
  std::vector<Stretch> apart;
  constexpr double nearly =
      1e-6;  // a stretch that begins or ends so near an end of the edge begins or ends there
  for (auto [from, to] : stretches) {
    if (from < nearly) from = 0.0;
    if (to > 1.0 - nearly) to = 1.0;
    if (!apart.empty() && from <= apart.back().second + nearly) {
      apart.back().second = std::max(apart.back().second, to);
    } else {
      apart.emplace_back(from, to);
    }
  }
  return apart;
}

bool holds(const std::vector<int>& excavations, std::size_t excavation) {
  return std::ranges::find(excavations, static_cast<int>(excavation)) != excavations.end();
}

Vec2 place_of(const dynamics::Model& model, const dynamics::WallPoint& point) {
  return lerp(model.reference[at(point.vertex)], model.reference[at(model.surface.next[at(point.vertex)])],
              point.share);
}

/// m, from the start of a face to its end.
Vec2 way_along(const dynamics::Model& model, const dynamics::WallFace& face) {
  return place_of(model, {face.vertex, face.to}) - place_of(model, {face.vertex, face.from});
}

/// Of the longest face of a part of a wall: shorter ones, which corners of blocks leave, are not where the part ends.
constexpr double least_at_end = 0.1;

/// Sets the ends of a stretch of these faces, along a direction.
void set_ends(const dynamics::Model& model, std::span<const dynamics::WallFace> faces, Vec2 along,
              dynamics::WallStretch& stretch) {
  double longest = 0.0;
  for (const dynamics::WallFace& face : faces) longest = std::max(longest, norm(way_along(model, face)));
  std::vector<dynamics::WallPoint> ends;
  for (const dynamics::WallFace& face : faces) {
    if (norm(way_along(model, face)) < least_at_end * longest) continue;
    ends.push_back({face.vertex, face.from});
    ends.push_back({face.vertex, face.to});
  }
  const auto [from, to] = std::ranges::minmax_element(
      ends, {}, [&](const dynamics::WallPoint& end) { return dot(along, place_of(model, end)); });
  stretch.from = *from;
  stretch.to = *to;
  stretch.from_end = {place_of(model, *from), model.surface.block[at(from->vertex)]};
  stretch.to_end = {place_of(model, *to), model.surface.block[at(to->vertex)]};
}

/// Divides a wall under pressure into crown, sides and invert, by what its faces look at.
void add_stretches(const std::string& wall, const dynamics::Model& model, dynamics::WallPressure& pressure,
                   std::vector<dynamics::WallStretch>& stretches) {
  const Vec2 down = model.gravity == Vec2{} ? Vec2{0.0, -1.0} : normalized(model.gravity);
  pressure.element.resize(pressure.faces.size());
  for (const record::WallPart part :
       {record::WallPart::crown, record::WallPart::left, record::WallPart::right, record::WallPart::invert}) {
    std::vector<dynamics::WallFace> of_part;
    for (std::size_t f = 0; f < pressure.faces.size(); ++f) {
      // The rock is on the left of its edge.
      if (part_towards(perpendicular(way_along(model, pressure.faces[f])), down) != part) continue;
      pressure.element[f] = stretches.size();
      of_part.push_back(pressure.faces[f]);
    }
    if (of_part.empty()) continue;
    const bool is_level = part == record::WallPart::crown || part == record::WallPart::invert;
    dynamics::WallStretch& stretch = stretches.emplace_back();
    stretch.name = fmt::format("{}.{}", wall, record::wall_part_name(part));
    // To the right; upwards.
    set_ends(model, of_part, is_level ? perpendicular(down) : -1.0 * down, stretch);
  }
}

}  // namespace

std::vector<dynamics::WallFace> wall_faces(const RunSetup& setup, const dynamics::Model& model,
                                           std::size_t excavation,
                                           const std::optional<std::pair<double, double>>& arc) {
  const contact::Tolerances tolerances(model.block_size);
  const Ring& outline = setup.excavations[excavation].outline;
  const Vec2 centre = centroid({outline, {}});
  std::vector<dynamics::WallFace> faces;
  for (std::size_t b = 0; b < setup.system.blocks.size(); ++b) {
    if (model.blocks[b].fixed || holds(setup.system.blocks[b].excavations, excavation)) continue;
    for (int v = model.surface.block_begin[b]; v < model.surface.block_begin[b + 1]; ++v) {
      const Vec2 from = model.reference[at(v)], to = model.reference[at(model.surface.next[at(v)])];
      for (const Stretch& stretch : on_outline(from, to, outline, tolerances)) {
        const std::vector<Stretch> parts =
            arc ? within_arc(stretch, from, to, centre, *arc) : std::vector{stretch};
        for (const Stretch& part : parts) faces.push_back({v, part.first, part.second});
      }
    }
  }
  return faces;
}

std::shared_ptr<const dynamics::Coupling> wall_loads(const RunSetup& setup, const dynamics::Model& model) {
  std::vector<dynamics::WallPressure> pressures;
  std::vector<dynamics::WallStretch> stretches;
  for (std::size_t e = 0; e < setup.excavations.size(); ++e) {
    const SupportPressure& pressure = setup.excavations[e].pressure;
    if (pressure.empty()) continue;
    std::vector<dynamics::WallFace> faces = wall_faces(setup, model, e, pressure.arc);
    if (faces.empty())
      refuse(fmt::format("excavation.{}.pressure", setup.excavations[e].name),
             pressure.arc ? "no rock along this arc of the outline" : "no rock along the outline",
             "faces of blocks that are neither fixed nor taken out with it");
    pressures.push_back({static_cast<int>(e), std::move(faces), pressure.over_time, {}});
    add_stretches(setup.excavations[e].name, model, pressures.back(), stretches);
  }
  const bool releases =
      std::ranges::any_of(setup.stages, [](const record::Stage& stage) { return !stage.release.empty(); });
  if (pressures.empty() && !releases) return nullptr;
  return std::make_shared<dynamics::WallLoads>(std::move(pressures), std::move(stretches));
}

}  // namespace keyblock::simulation
