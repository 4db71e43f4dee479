#include "dynamics/step_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "core/index.h"
#include "core/known_size.h"
#include "core/lanes.h"
#include "linalg/block_kernels.h"

namespace keyblock::dynamics {

void StepProblem::build(const Model& model, const State& state, const Drive& drive,
                        const contact::Surface& surface, std::span<const contact::Contact> contacts,
                        std::span<const int> pairs, ThreadTeam& team, const ForContacts& for_contacts) {
  team_ = &team;
  surface_ = &surface;
  is_static_ = drive.is_static;
  if (model_ != &model) begin(model);
  terms_.build(model, state, drive, team);
  build_rows(state, drive, contacts, pairs, for_contacts);
}

void StepProblem::begin(const Model& model) {
  model_ = &model;
  block_of_unknown_.clear();
  bodies_.clear();
  most_vertices_ = 0;
  for (const contact::DividedEdge& edge : surface_->divided)
    most_vertices_ = std::max(most_vertices_, at(edge.pieces) + 1);
  for (const Block& block : model.blocks) {
    bodies_.push_back({static_cast<std::uint32_t>(block.first), block.fixed ? 0 : block.size, block.unknown,
                       block.fixed ? 0.0 : block.mass()});
    if (block.unknown >= 0) block_of_unknown_.push_back(bodies_.size() - 1);
  }
}

void StepProblem::derivative(const Row& row, Vec2 direction, std::vector<double>& a,
                             std::vector<double>& b) const {
  const auto add = [&](std::uint32_t point, Vec2 at_point, std::vector<double>& part) {
    for_vertices_of(point, [&](std::size_t v, double share) {
      add_at(phi_of(v), body_of(point).size, share * at_point, part.data());
    });
  };
  a.assign(2 * at(body_of(row.vertex).size), 0.0);
  b.assign(2 * at(body_of(row.from).size), 0.0);
  add(row.vertex, direction, a);
  add(row.from, -(1.0 - row.position) * direction, b);
  add(row.to, -row.position * direction, b);
}

void StepProblem::displace(std::span<const double> d, std::vector<Vec2>& u) const {
  const std::size_t vertices = surface_->position.size();
  u.resize(vertices + (most_vertices_ > 0 ? rows_.size() : 0));
  team_->for_range(bodies_.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) displace_block(b, d, u);
  });
  if (most_vertices_ == 0) return;
  team_->for_range(rows_.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) displace_point(c, u);
  });
}

void StepProblem::displace(std::span<const double> d, std::span<const std::size_t> blocks,
                           std::span<const std::size_t> contacts, std::span<Vec2> u) const {
  for (const std::size_t b : blocks) displace_block(b, d, u);
  if (most_vertices_ == 0) return;
  for (const std::size_t c : contacts) displace_point(c, u);
}

void StepProblem::displace_block(std::size_t b, std::span<const double> d, std::span<Vec2> u) const {
  for_vertex_values(*surface_, b, bodies_[b].size, &d[bodies_[b].first],
                    [&](std::size_t v, Vec2 x) { u[v] = x; });
}

/// Of a contact on a curved edge, whose vertices are displaced.
void StepProblem::displace_point(std::size_t c, std::span<Vec2> u) const {
  if (!is_on_curve(rows_[c].from)) return;
  Pair sum{};
  for_vertices_of_curve(c, [&](std::size_t v, double share) { sum += share * load_pair(u[v]); });
  u[surface_->position.size() + c] = vec2_of(sum);
}

/// Adds what the forces at the vertices of a block do to its coefficients.
void StepProblem::add_vertex_forces(std::size_t b, std::span<const Vec2> forces,
                                    std::span<double> out) const {
  double* coefficients = &out[bodies_[b].first];
  with_known_size(bodies_[b].size, [&](auto size) {
    if constexpr (std::is_same_v<decltype(size), int>) {
      for (std::size_t v = at(surface_->block_begin[b]); v < at(surface_->block_begin[b + 1]); ++v)
        add_at(phi_of(v), size, forces[v], coefficients);
    } else {
      add_vertex_forces(
          size, b, forces, [&](int k) { return load_pair(coefficients + 2 * k); }, coefficients);
    }
  });
}

/// The same where the size is known: what they do and, of each basis function k, start(k). Summed in registers.
template <int size, typename Start>
void StepProblem::add_vertex_forces(std::integral_constant<int, size>, std::size_t b,
                                    std::span<const Vec2> forces, const Start& start,
                                    double* coefficients) const {
  std::array<Pair, at(size)> sums;
  for (int k = 0; k < size; ++k) sums[at(k)] = start(k);
  for (std::size_t v = at(surface_->block_begin[b]); v < at(surface_->block_begin[b + 1]); ++v) {
    const Pair force = load_pair(forces[v]);
    for (int k = 0; k < size; ++k) sums[at(k)] += phi_of(v)[k] * force;
  }
  for (int k = 0; k < size; ++k) store_pair(coefficients + 2 * k, sums[at(k)]);
}

void StepProblem::add_vertex_forces(std::span<const Vec2> forces, std::span<double> out) const {
  team_->for_range(bodies_.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) add_vertex_forces(b, forces, out);
  });
}

void StepProblem::gradient_with(std::span<const double> d, std::span<const Vec2> forces,
                                std::span<double> g) const {
  team_->for_range(bodies_.size(), blocks_worth_threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = terms_.coefficients(i).first, last = terms_.coefficients(i).second;
      with_known_size(model_->moves(i) ? bodies_[i].size : 0, [&](auto size) {
        if constexpr (std::is_same_v<decltype(size), int>) {
          terms_.multiply(i, d, g);
          for (std::size_t k = first; k < last; ++k) g[k] -= terms_.right()[k];
          add_vertex_forces(i, forces, g);
        } else {
          std::array<Lanes, (2 * at(size) + lane_count - 1) / lane_count> terms;
          terms_.multiply(size, i, &d[first], [&](int k, int count, Lanes rows) {
            terms[at(k / lane_count)] = rows - load_first(&terms_.right()[first + at(k)], count);
          });
          const auto start = [&](int k) {
            const Lanes& of = terms[at(2 * k / lane_count)];
            return Pair{of[2 * k % lane_count], of[2 * k % lane_count + 1]};
          };
          add_vertex_forces(size, i, forces, start, &g[first]);
        }
      });
    }
  });
}

void StepProblem::gradient(std::span<const double> d, std::span<double> g) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) terms_.multiply(i, d, g);
  for (std::size_t k = 0; k < g.size(); ++k) g[k] -= terms_.right()[k];
  for (std::size_t c = 0; c < rows_.size(); ++c) {
    const Row& row = rows_[c];
    const Vec2 r = relative(row, d);
    const SpringArray::Force force =
        springs_.force_at(c, springs_.y0[c] - dot(row.normal, r), springs_.w0[c] + dot(row.tangent(), r));
    if (!force.is_zero()) add_contact_force(row, row.gradient(force), g);
  }
}

}  // namespace keyblock::dynamics
