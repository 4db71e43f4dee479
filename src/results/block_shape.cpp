#include "results/block_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/error.h"

namespace keyblock::results {
namespace {

template <class Position>
Polygon shape(const record::ModelRecord& model, std::size_t block, const Position& position) {
  Polygon polygon;
  const std::vector<int>& start = model.blocks[block].ring_start;
  for (std::size_t r = 0; r + 1 < start.size(); ++r) {
    Ring ring;
    for (int k = start[r]; k < start[r + 1]; ++k) ring.push_back(position(static_cast<std::size_t>(k)));
    if (r == 0)
      polygon.outer = std::move(ring);
    else
      polygon.holes.push_back(std::move(ring));
  }
  return polygon;
}

}  // namespace

Polygon block_shape(const record::ModelRecord& model, const record::Frame& frame, std::size_t block) {
  return shape(model, block, [&](std::size_t k) {
    const auto [ux, uy] = frame.displacement[k];
    return model.origin + model.vertices[k] + Vec2{ux, uy};
  });
}

Polygon block_shape(const record::ModelRecord& model, std::size_t block) {
  return shape(model, block, [&](std::size_t k) { return model.origin + model.vertices[k]; });
}

Vec2 block_displacement(const record::ModelRecord& model, const record::Frame& frame, std::size_t block) {
  // In local coordinates, where no digits are lost, and from the same outline twice.
  const Polygon before = shape(model, block, [&](std::size_t k) { return model.vertices[k]; });
  const Polygon after = shape(model, block, [&](std::size_t k) {
    const auto [ux, uy] = frame.displacement[k];
    return model.vertices[k] + Vec2{ux, uy};
  });
  return centroid(after) - centroid(before);
}

std::vector<std::array<int, 3>> block_triangles(const record::ModelRecord& model, std::size_t block) {
  const std::vector<int>& start = model.blocks[block].ring_start;
  const auto first = model.vertices.begin() + start.front(), last = model.vertices.begin() + start.back();
  const auto index = [&](Vec2 p) {
    return start.front() + static_cast<int>(std::find(first, last, p) - first);
  };
  std::vector<std::array<int, 3>> triangles;
  const Polygon polygon = shape(model, block, [&](std::size_t k) { return model.vertices[k]; });
  try {
    for (const auto& [a, b, c] : triangulate(polygon)) triangles.push_back({index(a), index(b), index(c)});
  } catch (const std::invalid_argument&) {
    Diagnostic diagnostic;
    diagnostic.where.file = "result.h5";
    diagnostic.found = fmt::format("block {}, whose outline crosses itself", block);
    diagnostic.expected = "outlines of blocks";
    throw InputError(std::move(diagnostic));
  }
  return triangles;
}

std::string status_name(record::BlockStatus status) {
  constexpr const char* names[] = {"in place", "loosened", "fallen", "excavated"};
  return names[static_cast<std::size_t>(status)];
}

std::string contact_state_name(record::ContactState state) {
  constexpr const char* names[] = {"open", "sliding", "locked"};
  return names[static_cast<std::size_t>(state)];
}

std::string edge_kind_name(cutting::EdgeKind kind) {
  constexpr const char* names[] = {"free", "joint set", "trace map", "excavation", "domain"};
  return names[static_cast<std::size_t>(kind)];
}

}  // namespace keyblock::results
