#pragma once
#include <span>
#include <vector>

#include "contact/law.h"
#include "linalg/block_solver.h"
#include "linalg/bordered_factor.h"

namespace keyblock::dynamics {

/// The few springs of a step that act otherwise than the factored matrix has them, taken into account without factoring anew.
///
/// On the way δ from an increment D, all other springs stay on the straight lines of the matrix A. With g the gradient at D,
///
///     δ = −A⁻¹ (g + Σ_s a_s φ_s),     φ_s = β_s(e_s),     e = e⁰ − C φ,     C_st = a_sᵀ A⁻¹ a_t = (L⁻¹ a_s)ᵀ (L⁻¹ a_t)
///
/// where e_s is the stretch of spring s at D + δ, e⁰ that at D − A⁻¹ g, a_s = ∂e_s/∂D, and β_s by how much its force differs from the straight line
/// through what g has of it (Woodbury's formula, with springs that may change their state). φ minimizes ½ φᵀ C φ + Σ ∫β_s de: as many
/// unknowns as springs.
class Corrections {
 public:
  /// A spring, and the straight line f₀ + k₀ e that goes on as the matrix has it in its place; k₀ is 0 or k.
  struct Law {
    contact::ClampedSpring<double> spring;
    double line_stiffness = 0.0, line_force = 0.0;

    /// β, N per thickness: the force beyond the straight line; and ∂β/∂e.
    [[nodiscard]] double excess(double stretch) const {
      return spring.force(stretch) - (line_force + line_stiffness * stretch);
    }
    [[nodiscard]] double excess_stiffness(double stretch) const {
      return (spring.is_elastic(stretch) ? spring.stiffness : 0.0) - line_stiffness;
    }
    /// −1, 1: at `low`, at `high`; 0: the spring acts.
    [[nodiscard]] int branch(double stretch) const {
      return spring.is_low(stretch) ? -1 : spring.is_high(stretch) ? 1 : 0;
    }
  };

  void clear() {
    size_ = 0;
    factor_.clear();
  }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Adds springs, with their a_s.
  void add(linalg::LowRankSolver& solver, std::span<const linalg::LowRankSolver::PairVector> springs);
  /// φ, given half of −A⁻¹ g, the law of every spring and its stretch at D. False when it is not found.
  [[nodiscard]] bool solve(const linalg::LowRankSolver& solver, std::span<const double> half,
                           std::span<const Law> laws, std::span<const double> stretch);
  [[nodiscard]] std::span<const double> forces() const { return force_; }
  /// δ, given half of −A⁻¹ g.
  void finish(linalg::LowRankSolver& solver, std::span<const double> half, std::span<double> d);

 private:
  /// Row s of C.
  [[nodiscard]] double* compliances(std::size_t s) { return &compliance_[s * room_]; }
  void make_room(std::size_t springs);
  [[nodiscard]] bool minimize(std::span<const Law> laws);
  void find_step();
  [[nodiscard]] std::size_t find_curved();
  [[nodiscard]] bool find_direction();

  std::size_t size_ = 0;
  std::vector<linalg::ForwardVector> half_;  ///< L⁻¹ a_s; of the first size_
  std::vector<double> compliance_;           ///< C, by rows of `room_` numbers
  std::size_t room_ = 0;
  std::vector<double> force_;  ///< φ
  /// A spring with ∂β/∂e ≠ 0.
  struct Curved {
    std::size_t spring = 0;
    double stiffness = 0.0;  ///< ∂β/∂e
    friend bool operator==(const Curved&, const Curved&) = default;
  };
  std::vector<Curved> curved_;
  linalg::BorderedFactor factor_;  ///< of their matrix C + diag(∂e/∂β)
  // Scratch.
  std::vector<double> stretch_, stiffness_, missing_;  ///< e; ∂β/∂e; β − φ
  std::vector<int> branch_;
  std::vector<double> direction_, step_;  ///< of φ; what it takes off e
  std::vector<double> right_, scaled_;
};

}  // namespace keyblock::dynamics
