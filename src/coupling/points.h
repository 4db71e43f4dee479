#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "contact/contact.h"
#include "contact/edge_curve.h"
#include "core/index.h"
#include "core/known_size.h"
#include "core/parallel.h"
#include "coupling/row.h"
#include "model/model.h"
#include "model/vertex_field.h"

namespace keyblock::dynamics {

/// The points of bodies that rows connect, and how they follow the increment: u = T D. In the order of u,
///
///     the vertices of the surface,   material points of couplings,   where edges are divided: the point of each contact on its curve
class Points {
 public:
  /// What rows read of a body: 24 bytes, which a cache has for all of them.
  struct Body {
    std::uint32_t first;  ///< of its coefficients
    int size;             ///< N; 0: fixed
    int unknown;
    double mass;  ///< kg/m; 0: fixed
  };

  void begin(const Model& model);
  /// At the start of a step of so many rows.
  void resize(std::size_t rows);
  /// Where contact c touches the edge of its block b: the ends of the edge, or its point on a curve.
  std::pair<std::uint32_t, std::uint32_t> place_contact(const contact::Contact& contact, std::size_t c);
  /// In the order in which couplings have them.
  [[nodiscard]] std::uint32_t material_point(std::size_t k) const {
    return static_cast<std::uint32_t>(surface_->position.size() + k);
  }

  [[nodiscard]] const Body& body(std::size_t block) const { return bodies_[block]; }
  /// The body with this number among the unknown ones.
  [[nodiscard]] std::size_t block_of_unknown(std::size_t unknown) const { return block_of_unknown_[unknown]; }
  [[nodiscard]] const Body& body_of(std::uint32_t point) const { return bodies_[at(block_of(point))]; }

  /// u of increment D, m, at every point of so many rows.
  void displace(std::span<const double> d, std::size_t rows, ThreadTeam& team, std::vector<Vec2>& u) const;
  /// The same of some blocks, and of points of some rows.
  void displace(std::span<const double> d, std::span<const std::size_t> blocks,
                std::span<const std::size_t> rows, std::span<Vec2> u) const;
  /// u of one point.
  [[nodiscard]] Vec2 displacement(std::uint32_t point, std::span<const double> d) const {
    const Body& body = body_of(point);
    Vec2 u;
    for_phi(point,
            [&](const double* phi, double share) { u += share * field_at(phi, body.size, &d[body.first]); });
    return u;
  }
  /// out += (∂u/∂D)ᵀ force, out: of the body of the point.
  void add_force(std::uint32_t point, Vec2 force, double* out) const {
    const int size = body_of(point).size;
    for_phi(point, [&](const double* phi, double share) { add_at(phi, size, share * force, out); });
  }

  /// Vertices and material points: forces are gathered at these.
  [[nodiscard]] std::size_t gathered() const { return surface_->position.size() + phi_of_point_.size(); }
  [[nodiscard]] bool is_on_curve(std::uint32_t point) const { return point >= gathered(); }
  /// Calls of_vertex(v, share) for the vertices of the curve on which contact c is.
  template <typename OfVertex>
  void for_vertices_of_curve(std::size_t c, const OfVertex& of_vertex) const {
    const PointOnCurve& point = on_curves_[c];
    const double* shares = &shares_on_curves_[c * most_vertices_];
    const auto for_pieces = [&](auto pieces) {
      for (int j = 0; j < pieces; ++j) of_vertex(at(point.first + j), shares[j]);
      of_vertex(at(point.end), shares[pieces]);
    };
    if (point.pieces == 2) return for_pieces(std::integral_constant<int, 2>{});
    for_pieces(point.pieces);
  }
  /// Adds what the forces at the gathered points of a block do to its coefficients.
  void add_forces(std::size_t block, std::span<const Vec2> forces, std::span<double> out) const;
  /// What they do and, of each basis function k, start(k). Summed in registers.
  template <int size, typename Start>
  void add_forces(std::integral_constant<int, size> of, std::size_t block, std::span<const Vec2> forces,
                  const Start& start, double* coefficients) const;

  /// Basis functions of its block at a vertex or a material point.
  [[nodiscard]] const double* phi_of(std::size_t point) const {
    const std::size_t vertices = surface_->position.size();
    return point < vertices ? phi_of_vertex(point) : phi_of_point_[point - vertices];
  }
  /// Calls what(φ) with the basis functions of block b of a row, at a position along its edge.
  template <typename Do>
  void with_phi(const Row& row, double position, const Do& what) const;

 private:
  /// Where a contact is on a curved edge.
  struct PointOnCurve {
    int edge = -1;                       ///< −1: it is on a straight one
    int first = 0, pieces = 0, end = 0;  ///< vertices of the whole edge: first … first + pieces − 1, end
  };

  [[nodiscard]] const double* phi_of_vertex(std::size_t v) const {
    return &surface_->phi[surface_->phi_begin[v]];
  }
  [[nodiscard]] std::size_t contact_on_curve(std::uint32_t point) const { return point - gathered(); }
  [[nodiscard]] int block_of(std::uint32_t point) const;
  /// The first vertex of a body and the one after its last; lines have none.
  [[nodiscard]] std::pair<std::size_t, std::size_t> vertices_of(std::size_t body) const {
    if (body >= blocks_) return {};
    return {at(surface_->block_begin[body]), at(surface_->block_begin[body + 1])};
  }
  template <typename OfPhi>
  void for_phi(std::uint32_t point, const OfPhi& of_phi) const {
    if (!is_on_curve(point)) return of_phi(phi_of(point), 1.0);
    for_vertices_of_curve(contact_on_curve(point),
                          [&](std::size_t v, double share) { of_phi(phi_of_vertex(v), share); });
  }
  template <typename OfPoint>
  void for_material_points(std::size_t block, const OfPoint& of_point) const;
  void displace_block(std::size_t block, std::span<const double> d, std::span<Vec2> u) const;
  void displace_on_curve(std::size_t c, std::span<Vec2> u) const;

  const contact::Surface* surface_ = nullptr;
  std::size_t blocks_ = 0;    ///< bodies with vertices; they come first
  std::vector<Body> bodies_;  ///< of every body
  std::vector<std::size_t> block_of_unknown_;
  std::vector<const double*> phi_of_point_;         ///< of material points
  std::vector<int> block_of_point_;                 ///< likewise
  std::vector<std::vector<std::size_t>> of_block_;  ///< material points of each block; empty: there are none
  std::vector<PointOnCurve> on_curves_;             ///< of every row, where there are any
  std::vector<double> shares_on_curves_;            ///< of their vertices, most_vertices_ of every row
  std::size_t most_vertices_ = 0;                   ///< of a divided edge; 0: no edge is divided
};

/// r of a row for increment D, m, except for the known part.
[[nodiscard]] inline Vec2 relative_displacement(const Points& points, const Row& row,
                                                std::span<const double> d) {
  return points.displacement(row.vertex, d) -
         lerp(points.displacement(row.from, d), points.displacement(row.to, d), row.position);
}

template <typename OfPoint>
void Points::for_material_points(std::size_t block, const OfPoint& of_point) const {
  if (of_block_.empty()) return;
  for (const std::size_t k : of_block_[block]) of_point(k);
}

template <int size, typename Start>
void Points::add_forces(std::integral_constant<int, size>, std::size_t b, std::span<const Vec2> forces,
                        const Start& start, double* coefficients) const {
  std::array<Pair, at(size)> sums;
  for (int k = 0; k < size; ++k) sums[at(k)] = start(k);
  const auto add = [&](const double* phi, Pair force) {
    for (int k = 0; k < size; ++k) sums[at(k)] += phi[k] * force;
  };
  const auto [begin, end] = vertices_of(b);
  for (std::size_t v = begin; v < end; ++v) add(phi_of_vertex(v), load_pair(forces[v]));
  for_material_points(b, [&](std::size_t k) { add(phi_of_point_[k], load_pair(forces[material_point(k)])); });
  for (int k = 0; k < size; ++k) store_pair(coefficients + 2 * k, sums[at(k)]);
}

template <typename Do>
void Points::with_phi(const Row& row, double position, const Do& what) const {
  const auto fill = [&](auto size, double* phi) {
    if (is_on_curve(row.from)) {
      const std::size_t c = contact_on_curve(row.from);
      const auto for_vertices = [&](const auto& add) {
        if (position == row.position) {
          for_vertices_of_curve(c, add);
        } else {
          contact::for_curve_vertices(*surface_, on_curves_[c].edge, position, add);
        }
      };
      std::fill_n(phi, int{size}, 0.0);
      for_vertices([&](std::size_t v, double share) {
        const double* of_vertex = phi_of_vertex(v);
        for (int k = 0; k < size; ++k) phi[k] += share * of_vertex[k];
      });
    } else {
      const double *from = phi_of(row.from), *to = phi_of(row.to);
      for (int k = 0; k < size; ++k) phi[k] = (1.0 - position) * from[k] + position * to[k];
    }
    what(phi);
  };
  with_known_size(body_of(row.from).size, [&](auto size) {
    if constexpr (std::is_same_v<decltype(size), int>) {
      std::vector<double> phi(at(size));
      fill(size, phi.data());
    } else {
      std::array<double, decltype(size)::value> phi;
      fill(size, phi.data());
    }
  });
}

}  // namespace keyblock::dynamics
