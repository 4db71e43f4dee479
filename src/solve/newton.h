#pragma once
#include <vector>

#include "solve/iterate.h"
#include "solve/local_solve.h"

namespace keyblock::dynamics {

/// Newton's method with an exact line search on the convex, piecewise quadratic Π(D): solves A p = −∇Π with the matrix at hand and goes to the
/// minimum of Π(D + αp), the root of a piecewise linear function of α.
///
/// Along p the gradient is known without the matrix: ∇Π(D + αp) = (1 − α) ∇Π(D) − α ρ, with ρ what an iterative solver left over, except for
/// rows that change their branch on the way, which are few. So is the slope that the line search needs.
class Newton {
 public:
  /// At the start of a step.
  void begin(const StepSystem& system);
  /// direction ← −A⁻¹ gradient, except for what is left in the residual; `exact`: the solver has the matrix of this step to all digits. False
  /// when it cannot be had.
  bool solve(const StepSystem& system, Iterate& iterate, bool exact, const OpenCloseResult& result);
  /// From D along the direction to the minimum. enough: residual ratio that is small enough after it. False when the linear solver gives up.
  bool go_along(const StepSystem& system, Iterate& iterate, double enough, bool exact,
                OpenCloseResult& result);

 private:
  /// Of coefficients of the direction of search: with those of the gradient, and of the residual.
  struct Products {
    double gradient = 0.0, residual = 0.0;
    Products& operator+=(const Products& other) {
      gradient += other.gradient;
      residual += other.residual;
      return *this;
    }
  };
  [[nodiscard]] Products products(const StepSystem& system, const Iterate& iterate) const;
  /// Calls body(begin, end) for the coefficients that the direction of search moves or whose residual it changes, in parts.
  template <typename Body>
  void for_reached_coefficients(const StepSystem& system, const Iterate& iterate, const Body& body) const;
  /// Likewise for the rows.
  template <typename Body>
  void for_reached_rows(const StepSystem& system, const Body& body) const;
  bool improve(const StepSystem& system, Iterate& iterate, bool exact) const;
  void find_direction(const StepSystem& system, Iterate& iterate) const;
  [[nodiscard]] double search_line(const StepSystem& system, const Iterate& iterate);
  void find_changes(const StepSystem& system, double alpha);
  void find_bends(const StepSystem& system, double alpha);
  [[nodiscard]] double slope(const SpringArray& springs, double alpha) const;
  void go(const StepSystem& system, Iterate& iterate, double alpha) const;

  LocalSolve local_;
  std::vector<std::size_t> changes_;  ///< rows that change their branch along the direction of search
  std::vector<FaceBend> bends_;       ///< faces of joints whose pressure is not linear along it
  double slope_at_zero_ = 0.0, curvature_ = 0.0;
  /// The way of the first system of all blocks is gone to its end: few rows would hold all blocks back, and what these do otherwise is
  /// mended by local solves.
  bool may_go_whole_way_ = false;
};

}  // namespace keyblock::dynamics
