#pragma once
#include <span>
#include <vector>

#include "contact/law.h"
#include "linalg/block_solver.h"

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

  void clear() { size_ = 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  /// Adds a spring; a and b: the parts of a_s.
  void add(linalg::LowRankSolver& solver, linalg::LowRankSolver::Part a, linalg::LowRankSolver::Part b);
  /// φ, given half of −A⁻¹ g, the law of every spring and its stretch at D. False when it is not found.
  [[nodiscard]] bool solve(const linalg::LowRankSolver& solver, std::span<const double> half,
                           std::span<const Law> laws, std::span<const double> stretch);
  [[nodiscard]] std::span<const double> forces() const { return force_; }
  /// δ, given half of −A⁻¹ g.
  void finish(linalg::LowRankSolver& solver, std::span<const double> half, std::span<double> d);

 private:
  [[nodiscard]] double compliance(std::size_t s, std::size_t t) const {
    return s < t ? compliance_[t * (t + 1) / 2 + s] : compliance_[s * (s + 1) / 2 + t];
  }
  [[nodiscard]] double compliance_times(std::size_t s, std::span<const double> x) const;
  void assemble();
  [[nodiscard]] bool factor();
  [[nodiscard]] bool find_direction();

  std::size_t size_ = 0;
  std::vector<linalg::ForwardVector> half_;  ///< L⁻¹ a_s; of the first size_
  std::vector<double> compliance_;           ///< lower triangle by rows
  std::vector<double> force_;                ///< φ
  // Scratch.
  std::vector<double> stretch_, stiffness_, missing_;  ///< e; ∂β/∂e; β − φ
  std::vector<int> branch_;
  std::vector<double> direction_, step_;  ///< of φ; what it takes off e
  std::vector<std::size_t> curved_;       ///< springs with ∂β/∂e ≠ 0
  std::vector<double> triangle_, right_;
  std::vector<double> scaled_;
};

}  // namespace keyblock::dynamics
