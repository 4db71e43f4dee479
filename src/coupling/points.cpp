#include "coupling/points.h"

#include <algorithm>

#include "coupling/coupling.h"
#include "model/worth_threads.h"

namespace keyblock::dynamics {

void Points::begin(const Model& model) {
  surface_ = &model.surface;
  bodies_.clear();
  block_of_unknown_.clear();
  blocks_ = model.blocks.size();
  for (std::size_t b = 0; b < model.bodies(); ++b) {
    const dynamics::Body& body = model.body(b);
    bodies_.push_back({static_cast<std::uint32_t>(body.first), body.fixed ? 0 : body.size, body.unknown,
                       body.fixed ? 0.0 : body.mass()});
    if (body.unknown >= 0) block_of_unknown_.push_back(b);
  }
  most_vertices_ = 0;
  for (const contact::DividedEdge& edge : surface_->divided)
    most_vertices_ = std::max(most_vertices_, at(edge.pieces) + 1);
  phi_of_point_.clear();
  block_of_point_.clear();
  of_block_.clear();
  for (const auto& coupling : model.couplings) {
    for (const MaterialPoint& point : coupling->points()) {
      of_block_.resize(model.bodies());
      of_block_[at(point.block)].push_back(phi_of_point_.size());
      phi_of_point_.push_back(point.phi.data());
      block_of_point_.push_back(point.block);
    }
  }
}

void Points::resize(std::size_t rows) {
  if (most_vertices_ == 0) return;
  on_curves_.resize(rows);
  shares_on_curves_.resize(rows * most_vertices_);
}

std::pair<std::uint32_t, std::uint32_t> Points::place_contact(const contact::Contact& contact,
                                                              std::size_t c) {
  if (most_vertices_ > 0) on_curves_[c] = {};
  if (!contact::is_curved(*surface_, contact.edge))
    return {static_cast<std::uint32_t>(contact.edge),
            static_cast<std::uint32_t>(surface_->next[at(contact.edge)])};
  const contact::DividedEdge& whole = surface_->divided[at(contact.edge)];
  on_curves_[c] = {contact.edge, whole.first, whole.pieces,
                   surface_->next[at(whole.first + whole.pieces - 1)]};
  double* share = &shares_on_curves_[c * most_vertices_];
  contact::for_curve_vertices(*surface_, contact.edge, contact.position,
                              [&](std::size_t, double of_vertex) { *share++ = of_vertex; });
  const auto point = static_cast<std::uint32_t>(gathered() + c);
  return {point, point};
}

int Points::block_of(std::uint32_t point) const {
  const std::size_t vertices = surface_->position.size();
  if (point < vertices) return surface_->block[point];
  if (!is_on_curve(point)) return block_of_point_[point - vertices];
  return surface_->block[at(on_curves_[contact_on_curve(point)].edge)];
}

void Points::displace(std::span<const double> d, std::size_t rows, ThreadTeam& team,
                      std::vector<Vec2>& u) const {
  u.resize(gathered() + (most_vertices_ > 0 ? rows : 0));
  team.for_range(bodies_.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) displace_block(b, d, u);
  });
  if (most_vertices_ == 0) return;
  team.for_range(rows, contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) displace_on_curve(c, u);
  });
}

void Points::displace(std::span<const double> d, std::span<const std::size_t> blocks,
                      std::span<const std::size_t> rows, std::span<Vec2> u) const {
  for (const std::size_t b : blocks) displace_block(b, d, u);
  if (most_vertices_ == 0) return;
  for (const std::size_t c : rows) displace_on_curve(c, u);
}

void Points::displace_block(std::size_t b, std::span<const double> d, std::span<Vec2> u) const {
  const int size = bodies_[b].size;
  const double* of_block = &d[bodies_[b].first];
  if (b < blocks_) for_vertex_values(*surface_, b, size, of_block, [&](std::size_t v, Vec2 x) { u[v] = x; });
  for_material_points(
      b, [&](std::size_t k) { u[material_point(k)] = field_at(phi_of_point_[k], size, of_block); });
}

/// Of a contact on a curved edge, whose vertices are displaced.
void Points::displace_on_curve(std::size_t c, std::span<Vec2> u) const {
  if (on_curves_[c].edge < 0) return;
  Pair sum{};
  for_vertices_of_curve(c, [&](std::size_t v, double share) { sum += share * load_pair(u[v]); });
  u[gathered() + c] = vec2_of(sum);
}

void Points::add_forces(std::size_t b, std::span<const Vec2> forces, std::span<double> out) const {
  double* coefficients = &out[bodies_[b].first];
  with_known_size(bodies_[b].size, [&](auto size) {
    if constexpr (std::is_same_v<decltype(size), int>) {
      const auto [begin, end] = vertices_of(b);
      for (std::size_t v = begin; v < end; ++v) add_at(phi_of_vertex(v), size, forces[v], coefficients);
      for_material_points(
          b, [&](std::size_t k) { add_at(phi_of_point_[k], size, forces[material_point(k)], coefficients); });
    } else {
      add_forces(
          size, b, forces, [&](int k) { return load_pair(coefficients + 2 * k); }, coefficients);
    }
  });
}

}  // namespace keyblock::dynamics
