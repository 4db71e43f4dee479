#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "contact/detection.h"
#include "contact/law.h"
#include "core/parallel.h"
#include "dynamics/integrator.h"
#include "dynamics/model.h"
#include "dynamics/spring_array.h"
#include "dynamics/state.h"
#include "linalg/block_solver.h"

namespace keyblock::dynamics {

using contact::blocks_worth_threads;
using contact::contacts_worth_threads;
inline constexpr std::size_t coefficients_worth_threads = 20'000;

/// What drives one step.
struct Drive {
  double step = 0.0;         ///< s, Δt
  double end_time = 0.0;     ///< s, at which loads and supports are taken
  Vec2 ground_acceleration;  ///< m/s², mean over the step
  bool is_static = false;    ///< velocities are dropped; inertia only keeps the step small
  /// Static only: factor on the inertia of each block.
  std::span<const double> inertia_scale;
  std::span<const Integrator> rule;  ///< of each block
  /// m, of each block: what a fixed block is moved by in the step; empty when none is.
  std::span<const Vec2> prescribed;
};

/// The minimization that a step is (formulation, equation 3), with the Coulomb bounds frozen:
///
///     Π(D) = ½ Dᵀ H D − bᵀ D + Σ_contacts ψ_c(r_c(D)),      H = c/Δt² M + K_t + K_support  (block diagonal)
///     b = f_ext − f_int + f_support + M (c v/Δt + c_a a + c_F F)
///
/// Π is convex and piecewise quadratic. This class holds its data and evaluates it; it does not know how to minimize.
class StepProblem {
 public:
  /// r_c = φ_V · D_a − φ_P · D_b + moved; a fixed block contributes what it is moved by, nothing else. A cache line: every
  /// evaluation of the contacts reads it, and little else.
  struct alignas(64) Row {
    std::uint32_t first_a, first_b;  ///< of the block's coefficients
    std::uint32_t phi;   ///< into phi_: N values of a at its vertex, N of b at the point of its edge
    int size_a, size_b;  ///< N; 0: fixed
    int unknown_a, unknown_b;
    int pair = -1;  ///< of the solver's pattern; −1: one block is fixed
    Vec2 normal;
    Vec2 moved;  ///< m, known part of r: prescribed displacement of a less that of b

    [[nodiscard]] Vec2 tangent() const { return contact::tangent_of(normal); }
  };
  static_assert(sizeof(Row) == 64);

  /// pairs: of every candidate of contact, its pair of blocks in the solver's pattern, −1 with a fixed block.
  void build(const Model& model, const State& state, const Drive& drive, const contact::Surface& surface,
             std::span<const contact::Contact> contacts, std::span<const int> pairs, ThreadTeam& team);

  [[nodiscard]] std::vector<Row>& rows() { return rows_; }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Of every row. Built at D = 0, on the pieces that acted in the last step.
  [[nodiscard]] SpringArray& springs() { return springs_; }
  [[nodiscard]] const SpringArray& springs() const { return springs_; }
  /// Whether there are bonds that may break in this step.
  [[nodiscard]] bool may_break() const { return may_break_; }
  /// The spring of contact c, at the start of the step where its `memory` has it.
  [[nodiscard]] contact::Spring spring(const contact::Contact& contact, std::size_t c) const;
  /// Unknowns come first among the coefficients; those of fixed blocks follow.
  [[nodiscard]] std::size_t unknowns() const { return model_->unknowns; }

  /// N/m per thickness, of the two blocks of a contact against each other in this step.
  [[nodiscard]] double inertia_between(const contact::Contact& c) const;
  /// kg/m, of the two blocks of a contact; fixed ones count as infinite.
  [[nodiscard]] double reduced_mass(const contact::Contact& c) const;
  /// r of a contact for increment D, but for the known part.
  [[nodiscard]] Vec2 relative(const Row& row, std::span<const double> d) const {
    const double* phi = &phi_[row.phi];
    return displacement(phi, row.size_a, &d[row.first_a]) -
           displacement(phi + row.size_a, row.size_b, &d[row.first_b]);
  }
  /// g = ∇Π(D); the open-close iteration updates g instead.
  void gradient(std::span<const double> d, std::span<double> g) const;
  /// The increment of a block on which no contact acts, into d.
  void solve_alone(std::size_t block, std::span<double> d) const;
  /// y = H x.
  void multiply(std::span<const double> x, std::span<double> y) const;
  /// Sets the solver's matrix to H. With add_springs for all that act at r it becomes ∇²Π there.
  void assemble(linalg::BlockSolver& solver) const;
  /// The same for the block on the diagonal that belongs to one.
  void assemble_block(std::size_t block, linalg::BlockSolver& solver) const;
  /// Where a contact has its springs: normal of the edge, and how far along it.
  struct Place {
    Vec2 normal;
    double position = 0.0;
    explicit Place(const contact::Contact& c) : normal(c.normal), position(c.position) {}
    Place() = default;
    friend bool operator==(const Place&, const Place&) = default;
  };
  /// Springs at a contact, N/m per thickness; negative: taken away.
  struct SpringChange {
    std::size_t contact;
    int edge;
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
    const double* phi = &phi_[row.phi];
    add_scaled(phi, row.size_a, force, &out[row.first_a]);
    add_scaled(phi + row.size_a, row.size_b, -1.0 * force, &out[row.first_b]);
  }

  /// The same for all contacts, with force_of(c).
  template <typename ForceOf>
  void add_contact_forces(const ForceOf& force_of, std::span<double> out) const {
    for_owned_contacts(
        rows_.size(), [](std::size_t c) { return c; },
        [&](std::size_t c, Owner owner) {
          const Row& row = rows_[c];
          const Vec2 force = force_of(c);
          if (force == Vec2{}) return;
          const double* phi = &phi_[row.phi];
          if (owner.has(row.unknown_a)) add_scaled(phi, row.size_a, force, &out[row.first_a]);
          if (owner.has(row.unknown_b))
            add_scaled(phi + row.size_a, row.size_b, -1.0 * force, &out[row.first_b]);
        });
  }

  [[nodiscard]] std::span<const double> right() const { return b_; }
  /// Largest |g_k| of a block's coefficients over its weight (or what stands for it in a model without gravity).
  [[nodiscard]] double residual_ratio(std::span<const double> g) const;
  [[nodiscard]] bool moves(std::size_t block) const { return model_->moves(block); }
  [[nodiscard]] int unknown(std::size_t block) const { return bodies_[block].unknown; }
  [[nodiscard]] double block_size() const { return model_->block_size; }
  [[nodiscard]] double weight(std::size_t block) const { return weight_[block]; }
  /// Whether there is anything to measure residuals by: not without gravity, loads and shaking.
  [[nodiscard]] bool has_weights() const { return !weight_.empty() && weight_.front() > 0.0; }
  [[nodiscard]] double inertia(std::size_t block) const { return inertia_[block]; }
  [[nodiscard]] std::span<const double> inertias() const { return inertia_; }  ///< of all blocks
  /// Work that the elasticity of blocks and supports does not give back in a step of increment D that turns each block by
  /// `spin`: what the forces at the end of the step lose against the potential.
  struct ElasticLoss {
    /// ½ Dᵀ (K_t + K_support) D + Dᵀ K_t s − ½ sᵀ K_t s, with s = w × r the turn, which the pose update takes out of D.
    double numerical = 0.0;
    double damping = 0.0;  ///< by the viscosity of the rock
  };
  [[nodiscard]] ElasticLoss elastic_loss(const State& state, std::span<const double> d,
                                         std::span<const double> spin);

 private:
  /// Σ φ_k d_k of a block; N = 3 is order 1.
  static Vec2 displacement(const double* phi, int size, const double* d) {
    if (size == 3) {
      return {phi[0] * d[0] + phi[1] * d[2] + phi[2] * d[4], phi[0] * d[1] + phi[1] * d[3] + phi[2] * d[5]};
    }
    Vec2 u;
    for (int k = 0; k < size; ++k) u += phi[k] * Vec2{d[2 * k], d[2 * k + 1]};
    return u;
  }
  /// out_k += φ_k force.
  static void add_scaled(const double* phi, int size, Vec2 force, double* out) {
    const auto add = [&](int k) {
      out[2 * k] += phi[k] * force.x;
      out[2 * k + 1] += phi[k] * force.y;
    };
    if (size == 3) {
      add(0);
      add(1);
      add(2);
      return;
    }
    for (int k = 0; k < size; ++k) add(k);
  }
  /// Some of the unknown blocks, those of a thread. What contacts add to a block is added by its owner, in the order of the contacts,
  /// so that the sums are the same for any number of threads.
  struct Owner {
    int begin = -1, end = std::numeric_limits<int>::max();  ///< all, fixed ones too
    [[nodiscard]] bool has(int unknown) const { return unknown >= begin && unknown < end; }
  };
  /// Calls add(k, owner) for the k < n whose contact, contact_of(k), is one of a block of the owner, for all owners.
  template <typename ContactOf, typename Add>
  void for_owned_contacts(std::size_t n, const ContactOf& contact_of, const Add& add) const {
    if (team_->size() == 1 || n < contacts_worth_threads) {
      for (std::size_t k = 0; k < n; ++k) add(k, Owner{});
      return;
    }
    team_->for_range(model_->blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
      const Owner owner{static_cast<int>(begin), static_cast<int>(end)};
      for (std::size_t k = 0; k < n; ++k) {
        const auto [a, b] = unknowns_of_row_[contact_of(k)];
        if (owner.has(a) || owner.has(b)) add(k, owner);
      }
    });
  }
  void add_spring(const Row& row, Vec2 normal, const double* phi_b, double kn, double ks, Owner owner,
                  linalg::BlockSolver& solver) const;
  template <typename Size>
  void build_block(Size size, std::size_t i, const State& state, const Drive& drive, Vec2 acceleration);
  template <typename Size>
  [[nodiscard]] ElasticLoss block_loss(Size size, std::size_t i, const double* position, const double* d,
                                       double spin, double* turn, double* product) const;
  void build_blocks(const State& state, const Drive& drive);
  void add_supports(const State& state, const Drive& drive);
  void build_rows(const Drive& drive, const contact::Surface& surface,
                  std::span<const contact::Contact> contacts, std::span<const int> pairs);
  static void find_phi(const contact::Surface& surface, int edge, double position, int size, double* phi);
  void build_row(const Drive& drive, const contact::Surface& surface, const contact::Contact& c, Row& row);
  [[nodiscard]] SpringArray::Piece assumed_piece(contact::State state, std::size_t c, double origin) const;
  void build_springs(const Drive& drive, std::span<const contact::Contact> contacts, std::size_t first);

  /// What contacts read of a block: 24 bytes, which a cache has for all blocks.
  struct Body {
    std::uint32_t first;  ///< of its coefficients
    int size;             ///< N; 0: fixed
    int unknown;
    double mass;  ///< kg/m; 0: fixed
  };

  const Model* model_ = nullptr;
  ThreadTeam* team_ = nullptr;
  std::vector<Body> bodies_;  ///< of every block
  std::vector<Row> rows_;
  SpringArray springs_;  ///< of every row
  bool may_break_ = false;
  std::vector<std::pair<int, int>> unknowns_of_row_;  ///< the two of every row, to look through
  std::vector<double> phi_;                           ///< of every row, twice largest_size_
  int largest_size_ = 0;                              ///< N
  /// Per block: the first of its coefficients, and where they end.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> coefficients_;
  std::vector<std::size_t> h_first_;  ///< per block, into h_
  std::vector<double> h_;             ///< lower triangles, stride padded_rows(2N)
  std::vector<double> b_;
  std::vector<double> inertia_;      ///< per block, cρ/Δt²; 0: it does not move
  std::vector<double> viscous_;      ///< per block, β/Δt: viscosity of the rock over its stiffness
  std::vector<double> body_force_;   ///< per block, Block::body_force
  std::vector<double> weight_;       ///< per block, N-like scale of its coefficients
  std::vector<ElasticLoss> losses_;  ///< scratch, per block
};

}  // namespace keyblock::dynamics
