#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "contact/detection.h"
#include "contact/edge_curve.h"
#include "contact/law.h"
#include "core/parallel.h"
#include "dynamics/block_terms.h"
#include "dynamics/drive.h"
#include "dynamics/model.h"
#include "dynamics/spring_array.h"
#include "dynamics/state.h"
#include "dynamics/vertex_field.h"
#include "dynamics/worth_threads.h"
#include "linalg/block_solver.h"

namespace keyblock::dynamics {

/// The minimization that a step is (docs/theory.md, section "One step"), with the Coulomb bounds frozen:
///
///     Π(D) = ½ Dᵀ H D − bᵀ D + Σ_contacts ψ_c(r_c(D)),      H = c/Δt² M + K_t + K_support  (block diagonal)
///     b = f_ext − f_int + f_support + M (c v/Δt + c_a a + c_F F)
///
/// Π is convex and piecewise quadratic. This class holds its data and evaluates it; it does not know how to minimize.
class StepProblem {
 public:
  /// In place of a pair of blocks in the solver's pattern: one is fixed; the pattern does not have it.
  static constexpr int of_fixed = -1, without_room = -2;
  /// r_c = u(V) − (1 − s) u(A) − s u(B) + moved, u: displacement of points of the blocks, zero on fixed ones: of the vertices of the
  /// surface, which come first, and of the points P of contacts on curved edges, which follow. A cache line: every evaluation of the
  /// contacts reads it, and little else.
  struct alignas(64) Row {
    /// V of block a; A and B, the ends of the edge of block b, or P in the place of both.
    std::uint32_t vertex, from, to;
    int unknown_a, unknown_b;  ///< −1: fixed
    int pair = of_fixed;       ///< of the solver's pattern, or of_fixed, or without_room
    double position;           ///< s
    Vec2 normal;
    Vec2 moved;  ///< m, known part of r: prescribed displacement of a less that of b; Drive::rotation

    [[nodiscard]] Vec2 tangent() const { return contact::tangent_of(normal); }
    /// ∂ψ/∂r where the springs push with `force`.
    [[nodiscard]] Vec2 gradient(SpringArray::Force force) const {
      return force.shear * tangent() - force.normal * normal;
    }
    /// r, except for the known part.
    [[nodiscard]] Pair relative(std::span<const Vec2> u) const {
      return load_pair(u[vertex]) - lerp(load_pair(u[from]), load_pair(u[to]), position);
    }
  };
  static_assert(sizeof(Row) == 64);

  /// Calls of_some(first, last) for all contacts, piece by piece, each when what build() reads of it is known; threads may do so at once.
  using ForContacts = std::function<void(const contact::Detection::OfSome& of_some)>;
  /// pairs: Row::pair of every candidate of contact. for_contacts: {} where all contacts are known.
  void build(const Model& model, const State& state, const Drive& drive, const contact::Surface& surface,
             std::span<const contact::Contact> contacts, std::span<const int> pairs, ThreadTeam& team,
             const ForContacts& for_contacts = {});

  /// Whether there are contacts of pairs of blocks that the solver's pattern does not have; these come with set_pairs.
  [[nodiscard]] bool lacks_room() const { return lacks_room_; }
  void set_pairs(std::span<const contact::Contact> contacts, std::span<const int> pairs);

  [[nodiscard]] std::vector<Row>& rows() { return rows_; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Of every row. Built at D = 0, on the pieces that acted in the last step.
  [[nodiscard]] SpringArray& springs() { return springs_; }
  [[nodiscard]] const SpringArray& springs() const { return springs_; }
  [[nodiscard]] bool is_static() const { return is_static_; }
  /// Whether there are bonds that may break in this step.
  [[nodiscard]] bool may_break() const { return may_break_; }
  /// Whether the vertex of some contact is beyond an end of its edge by more than half of the edge.
  [[nodiscard]] bool has_distant() const { return has_distant_; }
  /// The spring of contact c, at the start of the step where its `memory` has it.
  [[nodiscard]] contact::Spring spring(const contact::Contact& contact, std::size_t c) const;
  /// Unknowns come first among the coefficients; those of fixed blocks follow.
  [[nodiscard]] std::size_t unknowns() const { return model_->unknowns; }

  /// N/m per thickness, of the two blocks of a contact against each other in this step.
  [[nodiscard]] double inertia_between(const contact::Contact& c) const;
  /// kg/m, of the two blocks of a contact; fixed ones count as infinite.
  [[nodiscard]] double reduced_mass(const contact::Contact& c) const;
  /// u of increment D, m, at every point: the vertices of the surface, then, where edges are divided, one of each contact.
  void displace(std::span<const double> d, std::vector<Vec2>& u) const;
  /// The same of some blocks, and of points of some contacts.
  void displace(std::span<const double> d, std::span<const std::size_t> blocks,
                std::span<const std::size_t> contacts, std::span<Vec2> u) const;
  /// r of a contact for increment D, except for the known part.
  [[nodiscard]] Vec2 relative(const Row& row, std::span<const double> d) const {
    const auto displacement = [&](std::uint32_t point) {
      const Body& body = body_of(point);
      Vec2 u;
      for_vertices_of(point, [&](std::size_t v, double share) {
        u += share * field_at(phi_of(v), body.size, &d[body.first]);
      });
      return u;
    };
    return displacement(row.vertex) - lerp(displacement(row.from), displacement(row.to), row.position);
  }
  /// g = ∇Π(D), contact by contact: the oracle of what the open-close iteration does by way of the vertices.
  void gradient(std::span<const double> d, std::span<double> g) const;
  /// Where a contact has its springs: normal of the edge, and how far along it.
  struct Place {
    Vec2 normal;
    double position = 0.0;
    explicit Place(const contact::Contact& c) : normal(c.normal), position(c.position) {}
    explicit Place(const Row& row) : normal(row.normal), position(row.position) {}
    Place() = default;
    friend bool operator==(const Place&, const Place&) = default;
  };
  /// Springs at a contact, N/m per thickness; negative: taken away.
  struct SpringChange {
    std::size_t contact;
    Place place;
    double normal, shear;
  };
  void add_springs(std::span<const SpringChange> changes, linalg::BlockSolver& solver) const;
  /// The same at all contacts.
  void add_springs(std::span<const double> normal, std::span<const double> shear,
                   linalg::BlockSolver& solver) const;
  /// (∂r/∂D)ᵀ direction: the parts of the two blocks, as long as their coefficients.
  void derivative(const Row& row, Vec2 direction, std::vector<double>& a, std::vector<double>& b) const;
  /// out += (∂r/∂D)ᵀ force.
  void add_contact_force(const Row& row, Vec2 force, std::span<double> out) const {
    const auto add = [&](std::uint32_t point, Vec2 at_point) {
      const Body& body = body_of(point);
      for_vertices_of(point, [&](std::size_t v, double share) {
        add_at(phi_of(v), body.size, share * at_point, &out[body.first]);
      });
    };
    add(row.vertex, force);
    add(row.from, -(1.0 - row.position) * force);
    add(row.to, -row.position * force);
  }

  /// The same for all contacts, with force_of(c). at_vertices: scratch.
  template <typename ForceOf>
  void add_contact_forces(const ForceOf& force_of, std::vector<Vec2>& at_vertices,
                          std::span<double> out) const {
    gather_forces(force_of, at_vertices);
    add_vertex_forces(at_vertices, out);
  }
  /// g = H D − b + Σ (∂r_c/∂D)ᵀ force_of(c), a block at a time while a cache has it. at_vertices: scratch.
  template <typename ForceOf>
  void gradient(std::span<const double> d, const ForceOf& force_of, std::vector<Vec2>& at_vertices,
                std::span<double> g) const {
    gather_forces(force_of, at_vertices);
    gradient_with(d, at_vertices, g);
  }

  [[nodiscard]] std::size_t blocks() const { return bodies_.size(); }
  [[nodiscard]] bool moves(std::size_t block) const { return model_->moves(block); }
  [[nodiscard]] int unknown(std::size_t block) const { return bodies_[block].unknown; }
  /// The block with this number among the unknown ones.
  [[nodiscard]] std::size_t block(std::size_t unknown) const { return block_of_unknown_[unknown]; }
  [[nodiscard]] double block_size() const { return model_->block_size; }
  /// H, b and what residuals are measured by: of blocks, loads and supports.
  [[nodiscard]] const BlockTerms& terms() const { return terms_; }
  [[nodiscard]] BlockTerms& terms() { return terms_; }

 private:
  /// What contacts read of a block: 24 bytes, which a cache has for all blocks.
  struct Body {
    std::uint32_t first;  ///< of its coefficients
    int size;             ///< N; 0: fixed
    int unknown;
    double mass;  ///< kg/m; 0: fixed
  };

  /// Where a contact is on a curved edge.
  struct PointOnCurve {
    int edge;
    int first, pieces, end;  ///< vertices of the whole edge: first … first + pieces − 1, end
  };

  /// What the contacts do to every vertex.
  template <typename ForceOf>
  void gather_forces(const ForceOf& force_of, std::vector<Vec2>& at_vertices) const {
    at_vertices.resize(surface_->position.size());
    team_->for_range(at_vertices.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) at_vertices[v] = {};
    });
    for_owned_rows([&](std::size_t c, Owner owner) {
      const Row& row = rows_[c];
      const Vec2 force = force_of(c);
      if (force == Vec2{}) return;
      const Pair pair = pair_of(force);
      const auto add = [&](std::size_t v, Pair p) {
        store_pair(at_vertices[v], load_pair(at_vertices[v]) + p);
      };
      if (owner.has(row.unknown_a)) add(row.vertex, pair);
      if (!owner.has(row.unknown_b)) return;
      if (is_on_curve(row.from)) {
        for_vertices_of_curve(c, [&](std::size_t v, double share) { add(v, -share * pair); });
      } else {
        add(row.from, -(1.0 - row.position) * pair);
        add(row.to, -row.position * pair);
      }
    });
  }
  void add_vertex_forces(std::size_t block, std::span<const Vec2> forces, std::span<double> out) const;
  template <int size, typename Start>
  void add_vertex_forces(std::integral_constant<int, size>, std::size_t block, std::span<const Vec2> forces,
                         const Start& start, double* coefficients) const;
  void add_vertex_forces(std::span<const Vec2> forces, std::span<double> out) const;
  void gradient_with(std::span<const double> d, std::span<const Vec2> forces, std::span<double> g) const;
  [[nodiscard]] bool is_on_curve(std::uint32_t point) const { return point >= surface_->position.size(); }
  [[nodiscard]] std::size_t contact_on_curve(std::uint32_t point) const {
    return point - surface_->position.size();
  }
  [[nodiscard]] const Body& body_of(std::uint32_t point) const {
    return bodies_[at(
        surface_->block[is_on_curve(point) ? at(on_curves_[contact_on_curve(point)].edge) : point])];
  }
  [[nodiscard]] const double* phi_of(std::size_t vertex) const {
    return &surface_->phi[surface_->phi_begin[vertex]];
  }
  /// Calls of_vertex(v, share) for the vertices that a point hangs on: itself, or all of its edge.
  template <typename OfVertex>
  void for_vertices_of(std::uint32_t point, const OfVertex& of_vertex) const {
    if (!is_on_curve(point)) return of_vertex(std::size_t{point}, 1.0);
    for_vertices_of_curve(contact_on_curve(point), of_vertex);
  }
  /// Of the point of contact c.
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
  void displace_block(std::size_t block, std::span<const double> d, std::span<Vec2> u) const;
  void displace_point(std::size_t contact, std::span<Vec2> u) const;
  template <typename Do>
  void with_phi(const Row& row, double position, const Do& what) const;
  /// Some of the unknown blocks, those of a thread. What contacts add to a block is added by its owner, in the order of the contacts,
  /// so that the sums are the same for any number of threads.
  struct Owner {
    int begin = -1, end = std::numeric_limits<int>::max();  ///< all, fixed ones too
    [[nodiscard]] bool has(int unknown) const { return unknown >= begin && unknown < end; }
  };
  /// Calls add(c, owner) for the contacts that have a block of the owner, for all owners. Rows come by their smaller block, so that
  /// most pieces of them are those of one owner.
  template <typename Add>
  void for_owned_rows(const Add& add) const {
    const std::size_t n = rows_.size();
    if (team_->size() == 1 || n < contacts_worth_threads) {
      for (std::size_t c = 0; c < n; ++c) add(c, Owner{});
      return;
    }
    team_->for_range(model_->blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
      const Owner owner{static_cast<int>(begin), static_cast<int>(end)};
      for (std::size_t p = 0; p < unknowns_of_piece_.size(); ++p) {
        const auto [least, most] = unknowns_of_piece_[p];
        if (most < owner.begin || least >= owner.end) continue;
        for (std::size_t c = p * rows_of_piece; c < std::min(n, (p + 1) * rows_of_piece); ++c) {
          const auto [a, b] = unknowns_of_row_[c];
          if (owner.has(a) || owner.has(b)) add(c, owner);
        }
      }
    });
  }
  void add_spring(const Row& row, const Place& place, double kn, double ks, Owner owner,
                  linalg::BlockSolver& solver) const;
  void begin(const Model& model);
  void build_rows(const State& state, const Drive& drive, std::span<const contact::Contact> contacts,
                  std::span<const int> pairs, const ForContacts& for_contacts);
  /// Of rows: what some of them are, that all of the problem asks for.
  struct RowFacts {
    bool may_break = false, lacks_room = false, has_distant = false;
  };
  RowFacts build_row(const Drive& drive, const contact::Contact& contact, int pair, std::size_t c);
  void place_row(const contact::Contact& contact, std::size_t c);
  void find_owners();
  void build_springs(const State& state, const Drive& drive, std::span<const contact::Contact> contacts,
                     std::size_t first);
  [[nodiscard]] Lanes ways_to_rest(const State& state, const Drive& drive,
                                   std::span<const contact::Contact> contacts, std::size_t first) const;
  [[nodiscard]] Vec2 moved_at_start(const State& state, const Drive& drive, std::size_t b) const;
  [[nodiscard]] double way_to_rest(const State& state, const Drive& drive, const contact::Contact& contact,
                                   const Row& row) const;

  const Model* model_ = nullptr;
  const contact::Surface* surface_ = nullptr;
  ThreadTeam* team_ = nullptr;
  BlockTerms terms_;
  std::vector<Body> bodies_;  ///< of every block
  std::vector<Row> rows_;
  SpringArray springs_;                   ///< of every row
  std::vector<PointOnCurve> on_curves_;   ///< of every row, where there are any
  std::vector<double> shares_on_curves_;  ///< of their vertices, most_vertices_ of every row
  std::size_t most_vertices_ = 0;         ///< of a divided edge; 0: no edge is divided
  bool is_static_ = false, may_break_ = false, lacks_room_ = false, has_distant_ = false;
  // Of several threads alone.
  static constexpr std::size_t rows_of_piece = 256;
  std::vector<std::pair<int, int>> unknowns_of_row_;    ///< the two of every row, to look through
  std::vector<std::pair<int, int>> unknowns_of_piece_;  ///< least and largest of so many rows
  std::vector<std::size_t> block_of_unknown_;
};

}  // namespace keyblock::dynamics
