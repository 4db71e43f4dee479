#pragma once
#include <span>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "coupling/block_terms.h"
#include "coupling/coupling.h"
#include "coupling/points.h"
#include "coupling/row.h"
#include "coupling/row_owners.h"
#include "coupling/spring_array.h"
#include "linalg/block_solver.h"
#include "model/drive.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// The minimization that a step is (docs/theory.md, section "One step"), with the Coulomb bounds frozen:
///
///     Π(D) = ½ Dᵀ H D − bᵀ D + Σ_rows ψ(r(D)),      H = c/Δt² M + K_t + K_support  (block diagonal)
///     b = f_ext − f_int + f_support + M (c v/Δt + c_a a + c_F F)
///
/// Π is convex and piecewise quadratic. H and b are BlockTerms; rows are those of contacts, which come first, and of other couplings. This
/// class holds the data and evaluates them; it does not know how to minimize.
class StepProblem {
 public:
  /// Contacts are the first coupling; the others are those of the model.
  void build(const Model& model, const State& state, const Drive& drive, const Coupling& contacts,
             ThreadTeam& team);

  /// A coupling and the first of its rows.
  struct Part {
    const Coupling* coupling;
    std::size_t first;
  };
  [[nodiscard]] std::span<const Part> parts() const { return parts_; }
  /// Names of all rows, the same from step to step.
  void name_rows(std::vector<Coupling::RowKey>& keys) const;
  [[nodiscard]] const RowFacts& facts() const { return facts_; }
  /// After the solver's pattern has changed.
  void find_pairs(std::span<const std::pair<int, int>> pattern);

  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Of every row. Built at D = 0, on the branches that acted in the last step.
  [[nodiscard]] SpringArray& springs() { return springs_; }
  [[nodiscard]] const SpringArray& springs() const { return springs_; }
  [[nodiscard]] const Points& points() const { return points_; }
  /// H, b and what residuals are measured by: of blocks, loads and supports.
  [[nodiscard]] const BlockTerms& terms() const { return terms_; }
  [[nodiscard]] const Model& model() const { return *model_; }
  /// At the start of the step.
  [[nodiscard]] const State& state() const { return *state_; }
  /// What part k of parts() remembers.
  [[nodiscard]] std::span<const double> memory(std::size_t k) const {
    return k == 0 ? std::span<const double>() : state_->couplings[k - 1];
  }
  [[nodiscard]] bool is_static() const { return is_static_; }

  /// u of increment D, m, at every point (Points).
  void displace(std::span<const double> d, std::vector<Vec2>& u) const {
    points_.displace(d, rows_.size(), *team_, u);
  }
  /// r of a row for increment D, except for the known part.
  [[nodiscard]] Vec2 relative(const Row& row, std::span<const double> d) const {
    return relative_displacement(points_, row, d);
  }
  void add_springs(std::span<const SpringChange> changes, linalg::BlockSolver& solver) const;
  /// The same at all rows.
  void add_springs(std::span<const double> normal, std::span<const double> shear,
                   linalg::BlockSolver& solver) const;
  /// Adds to the matrix what the pressure of a face does: h_ij, by rows, of the penetrations at rows i and j, which are at these places;
  /// scale: 1, or −1 to take it away.
  void add_face(std::span<const std::size_t> rows, std::span<const Place> places, std::span<const double> h,
                double scale, linalg::BlockSolver& solver) const;
  /// (∂r/∂D)ᵀ direction: the parts of the two blocks, as long as their coefficients.
  void derivative(const Row& row, Vec2 direction, std::vector<double>& a, std::vector<double>& b) const;
  /// out += (∂r/∂D)ᵀ force.
  void add_force(const Row& row, Vec2 force, std::span<double> out) const {
    const auto add = [&](std::uint32_t point, Vec2 at_point) {
      points_.add_force(point, at_point, &out[points_.body_of(point).first]);
    };
    add(row.vertex, force);
    add(row.from, -(1.0 - row.position) * force);
    add(row.to, -row.position * force);
  }
  /// The same for all rows, with force_of(row). at_points: scratch.
  template <typename ForceOf>
  void add_forces(const ForceOf& force_of, std::vector<Vec2>& at_points, std::span<double> out) const {
    gather_forces(force_of, at_points);
    add_gathered_forces(at_points, out);
  }
  /// g = H D − b + Σ (∂r/∂D)ᵀ force_of(row), a block at a time while a cache has it. at_points: scratch.
  template <typename ForceOf>
  void gradient(std::span<const double> d, const ForceOf& force_of, std::vector<Vec2>& at_points,
                std::span<double> g) const {
    gather_forces(force_of, at_points);
    gradient_with(d, at_points, g);
  }

 private:
  /// What the rows do to every vertex and material point.
  template <typename ForceOf>
  void gather_forces(const ForceOf& force_of, std::vector<Vec2>& at_points) const {
    at_points.resize(points_.gathered());
    team_->for_range(at_points.size(), contacts_worth_threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) at_points[v] = {};
    });
    owners_.for_rows(model_->bodies(), *team_, [&](std::size_t c, RowOwners::Owner owner) {
      const Row& row = rows_[c];
      const Vec2 force = force_of(c);
      if (force == Vec2{}) return;
      const Pair pair = pair_of(force);
      const auto add = [&](std::size_t v, Pair p) { store_pair(at_points[v], load_pair(at_points[v]) + p); };
      if (owner.has(row.unknown_a)) add(row.vertex, pair);
      if (!owner.has(row.unknown_b)) return;
      if (points_.is_on_curve(row.from)) {
        points_.for_vertices_of_curve(c, [&](std::size_t v, double share) { add(v, -share * pair); });
      } else {
        add(row.from, -(1.0 - row.position) * pair);
        add(row.to, -row.position * pair);
      }
    });
  }
  void add_gathered_forces(std::span<const Vec2> forces, std::span<double> out) const;
  void gradient_with(std::span<const double> d, std::span<const Vec2> forces, std::span<double> g) const;
  void add_spring(const Row& row, const Place& place, double kn, double ks, RowOwners::Owner owner,
                  linalg::BlockSolver& solver) const;

  const Model* model_ = nullptr;
  const State* state_ = nullptr;
  ThreadTeam* team_ = nullptr;
  std::vector<Part> parts_;
  BlockTerms terms_;
  Points points_;
  RowOwners owners_;
  std::vector<Row> rows_;
  SpringArray springs_;  ///< of every row
  RowFacts facts_;
  bool is_static_ = false;
};

/// g = ∇Π(D), row by row: the oracle of what the open-close iteration does by way of the vertices.
void gradient_by_rows(const StepProblem& problem, std::span<const double> d, std::span<double> g);

}  // namespace keyblock::dynamics
