#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/lanes.h"
#include "core/parallel.h"
#include "linalg/block_kernels.h"
#include "linalg/block_solver.h"
#include "model/drive.h"
#include "model/model.h"
#include "model/state.h"

namespace keyblock::dynamics {

/// What a step has of its bodies, loads and supports: the quadratic part of the minimization (docs/theory.md, section "One step"),
///
///     ½ Dᵀ H D − bᵀ D,      H = c/Δt² M + K_t + K_support  (block diagonal),      b = f_ext − f_int + f_support + M (c v/Δt + c_a a + c_F F)
///
/// and the weights by which residuals of blocks are measured. Coefficients are those of D, by Block::first.
class BlockTerms {
 public:
  void build(const Model& model, const State& state, const Drive& drive, ThreadTeam& team);

  /// Adds a spring at a point of a block, in the direction of an axis (0: x, 1: y): stiffness, N/m per thickness, and the force that it has
  /// at D = 0, N per thickness. phi: the N basis functions at the point.
  void add_spring(std::size_t block, int axis, std::span<const double> phi, double stiffness, double force);

  /// Adds a spring that acts on Σ φ_k a_k along a direction of length 1, of a body: stiffness and force likewise.
  void add_spring(std::size_t body, Vec2 along, std::span<const double> phi, double stiffness, double force);

  /// Adds the same stiffness, N/m per thickness and unit area, to all coefficients of a block, and the force that each has at D = 0.
  void add_drag(std::size_t block, double stiffness, std::span<const double> force);

  /// Adds a force at a point of a body, N per thickness. phi: the N basis functions at the point.
  void add_force(std::size_t body, const double* phi, Vec2 force);

  /// y = H x, of one block.
  void multiply(std::size_t block, std::span<const double> x, std::span<double> y) const;
  /// Calls of_rows(first, count, rows) with the rows of H x of one block of N basis functions, as many at once as there are lanes: in
  /// registers, as what is stored in part cannot be loaded again at once. x: of the block.
  template <typename Size, typename OfRows>
  void multiply(Size size, std::size_t block, const double* x, const OfRows& of_rows) const {
    const int n = 2 * size, stride = linalg::padded_rows(n);
    const double* h = &h_[h_first_[block]];
    in_lanes(n, [&](int first, int count) {
      Lanes rows{};
      for (int c = 0; c < n; ++c) rows += load(h + c * stride + first) * broadcast(x[c]);
      of_rows(first, count, rows);
    });
  }
  /// The increment of a block on which no contact acts, into d.
  void solve_alone(std::size_t block, std::span<double> d) const;
  /// Sets the solver's matrix to H.
  void assemble(linalg::BlockSolver& solver) const;
  /// The same for the block on the diagonal that belongs to one.
  void assemble_block(std::size_t block, linalg::BlockSolver& solver) const;
  [[nodiscard]] std::span<const double> right() const { return b_; }  ///< b

  /// Once b is known: without gravity, raises weights to a share of what makes the step, so that none is zero in a step in which anything
  /// happens. row_force: N per thickness, the largest of a spring of the rows at D = 0.
  void weigh_motion(const Drive& drive, double row_force);
  /// Largest |g_k| of a block's coefficients over its weight (or what stands for it in a model without gravity). Infinite where a force
  /// is out of balance that nothing measures.
  [[nodiscard]] double residual_ratio(std::span<const double> g) const;
  /// The ratio of one block.
  [[nodiscard]] double residual_ratio(std::size_t block, std::span<const double> g) const;
  [[nodiscard]] double weight(std::size_t block) const { return weight_[block]; }
  /// Whether there is anything to measure residuals by. Where there is not, nothing acts and nothing moves: the step is D = 0.
  [[nodiscard]] bool has_weights() const { return has_weights_; }
  /// N/m per thickness and unit area: largest of a coefficient of the block, without inertia.
  [[nodiscard]] double largest_stiffness(std::size_t block) const;
  /// cρ/Δt², of each body; 0: it does not move.
  [[nodiscard]] std::span<const double> inertias() const { return inertia_; }
  [[nodiscard]] double inertia(std::size_t block) const { return inertia_[block]; }
  /// The first coefficient of a block, and the one after its last.
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> coefficients(std::size_t block) const {
    return coefficients_[block];
  }

  /// Work that the elasticity of blocks and supports does not give back in a step of increment D that turns each block by
  /// `spin`: what the forces at the end of the step lose against the potential.
  struct ElasticLoss {
    /// ½ Dᵀ (K_t + K_support) D + Dᵀ K_t s − ½ sᵀ K_t s, with s = w × r the turn, which the pose update takes out of D. In static steps, which
    /// may be long, less what the elastic energy changes by beyond second order.
    double numerical = 0.0;
    double damping = 0.0;  ///< by the viscosity of the rock
  };
  [[nodiscard]] ElasticLoss elastic_loss(const State& state, std::span<const double> d,
                                         std::span<const double> spin) const;

 private:
  struct PressedBlocks;
  void begin(const Model& model);
  template <typename Size>
  void linearize(Size size, std::size_t i, const State& state, const Drive& drive, Vec2 acceleration,
                 double* geometric);
  template <typename Size>
  void build_block(Size size, std::size_t i, const State& state, const Drive& drive, Vec2 acceleration,
                   PressedBlocks& pressed);
  template <typename Size>
  void finish_block(Size size, std::size_t i, const double* geometric);
  void finish_blocks(PressedBlocks& pressed);
  void build_blocks(const State& state, const Drive& drive);
  template <typename Size>
  void add_motion(Size size, std::size_t i, const State& state, const Drive& drive);
  void build_line(std::size_t i, const State& state, const Drive& drive);
  void build_lines(const State& state, const Drive& drive);
  void weigh_lines();
  void make_rigid(std::size_t block, const State& state);
  void add_loads(const State& state, const Drive& drive);
  [[nodiscard]] double largest_of_right(std::size_t i) const;
  template <typename Size>
  [[nodiscard]] ElasticLoss block_loss(Size size, std::size_t i, const double* position, const double* d,
                                       double spin, double* turn, double* strained) const;

  const Model* model_ = nullptr;
  ThreadTeam* team_ = nullptr;
  int largest_size_ = 0;  ///< N
  std::vector<std::pair<std::uint32_t, std::uint32_t>> coefficients_;
  std::vector<std::size_t> h_first_;  ///< per body, into h_
  std::vector<double> h_;             ///< H of each, columns of padded_rows(2N)
  std::vector<double> b_;
  std::vector<double> inertia_;
  std::vector<double>
      rigid_;  ///< per block that strikes another one: what its change of shape is held with; else 0
  std::vector<double> viscous_;     ///< per block, β/Δt: viscosity of the rock over its stiffness
  std::vector<double> body_force_;  ///< per block, Block::body_force
  std::vector<double> frequency_;   ///< rad/s, per block: its first elastic one, about
  std::vector<double> weight_;      ///< per body, N-like scale of its coefficients
  bool has_weights_ = false, is_static_ = false;
  std::vector<double> stress_;  ///< the same of its in-situ stress, where there is no gravity; else 0
};

}  // namespace keyblock::dynamics
