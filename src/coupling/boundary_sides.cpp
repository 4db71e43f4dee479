#include "coupling/boundary_sides.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/index.h"
#include "coupling/seismic_boundary.h"
#include "model/model.h"
#include "model/state.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

namespace {

/// By the outward normal of the model.
constexpr std::pair<const char*, Vec2> all_sides[] = {{"boundary.left", {-1.0, 0.0}},
                                                      {"boundary.right", {1.0, 0.0}},
                                                      {"boundary.base", {0.0, -1.0}},
                                                      {"boundary.top", {0.0, 1.0}}};

Vec2 place_now(const BoundaryPoint& p, const Model& model, const State& state) {
  const Block& block = model.blocks[at(p.point.block)];
  return field_at(p.point.phi.data(), block.size, &state.position[block.first]);
}

}  // namespace

BoundarySides::BoundarySides(std::span<const BoundaryPoint> points) : side_of_(points.size(), -1) {
  for (const auto& [name, normal] : all_sides) {
    std::vector<std::size_t> of_side;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (dot(points[k].normal, normal) > 0.5) of_side.push_back(k);
    const auto acts = [&](std::size_t k) { return points[k].springs != Vec2{} || points[k].absorbs; };
    if (std::ranges::none_of(of_side, acts)) continue;
    // To the right along base and top, upwards along the others.
    const Vec2 along{std::abs(normal.y), std::abs(normal.x)};
    const auto [first, last] =
        std::ranges::minmax_element(of_side, {}, [&](std::size_t k) { return dot(along, points[k].place); });
    for (const std::size_t k : of_side) side_of_[k] = static_cast<int>(sides_.size());
    sides_.push_back({name, *first, *last});
  }
}

std::vector<Element> BoundarySides::elements(std::span<const BoundaryPoint> points) const {
  const auto end = [&](std::size_t k) { return ElementEnd{points[k].place, points[k].point.block}; };
  std::vector<Element> all;
  for (const Side& side : sides_)
    all.push_back({"boundary", side.name, HUGE_VAL, end(side.first), end(side.last)});
  return all;
}

std::vector<Carried> BoundarySides::carried(std::span<const BoundaryPoint> points,
                                            std::span<const Vec2> tractions, const Model& model,
                                            const State& state) const {
  std::vector<Carried> all(sides_.size());
  std::vector<Vec2> force(sides_.size()), moved(sides_.size());
  std::vector<double> length(sides_.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const BoundaryPoint& p = points[k];
    if (side_of_[k] < 0 || !model.moves(at(p.point.block))) continue;
    const std::size_t s = at(side_of_[k]);
    force[s] += p.length * tractions[k];
    moved[s] += p.length * (place_now(p, model, state) - p.place);
    length[s] += p.length;
  }
  for (std::size_t s = 0; s < sides_.size(); ++s) {
    all[s] = {.from = place_now(points[sides_[s].first], model, state),
              .to = place_now(points[sides_[s].last], model, state),
              .force = norm(force[s]),
              .elongation = length[s] > 0.0 ? norm(moved[s]) / length[s] : 0.0,
              .present = length[s] > 0.0};
  }
  return all;
}

}  // namespace keyblock::dynamics
