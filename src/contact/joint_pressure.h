#pragma once
#include <span>

#include "contact/edge_curve.h"

namespace keyblock::contact {

/// The pressure along a stretch of joint that blocks press or open unevenly. Its contacts stand at points s_i from 0 to 1 of it. With y_i, how far
/// the sides are pressed into each other there, and Lagrange's polynomials N_i through the points,
///
///     y(s) = Σ N_i(s) y_i       p(s) = k max(y(s), 0), and k y(s) where the joint pulls, too
///     ψ = ½ k a ∫ max(y, 0)² ds       F_i = ∂ψ/∂y_i = k a ∫ max(y, 0) N_i ds       H_ij = ∂²ψ/∂y_i∂y_j = k a ∫_{y > 0} N_i N_j ds
///
/// k: Pa/m, normal stiffness of the joint; a: m, its length; K = k a. ψ is convex and has a continuous slope. With contacts at both ends y is
/// linear and the pressure a triangle or a trapezium, which is exact for blocks of order 1. ψ is homogeneous: F = H y and ψ = ½ F·y.
class JointPressure {
 public:
  /// stiffness: K, N/m per thickness. points: s_i. pulls: the joint is a bond that bears tension.
  JointPressure(double stiffness, const EdgeDivision& points, bool pulls)
      : stiffness_(stiffness), points_(&points), pulls_(pulls) {}

  [[nodiscard]] double stiffness() const { return stiffness_; }
  [[nodiscard]] std::size_t size() const { return points_->points.size(); }
  [[nodiscard]] bool pulls() const { return pulls_; }
  void pull_no_more() { pulls_ = false; }
  [[nodiscard]] JointPressure stiffer(double times) const { return {stiffness_ * times, *points_, pulls_}; }

  /// F_i, N per thickness, from y_i, m.
  void forces(std::span<const double> y, std::span<double> force) const;
  /// F_i, and what of the pressure each contact bears for friction,
  ///
  ///     B_i = k a ∫ max(y, 0) h_i ds,    h_i: 1 at s_i, 0 at the other points, straight between
  ///
  /// Σ B_i = Σ F_i and Σ s_i B_i = Σ s_i F_i, and no B_i is negative where the joint does not pull. Where it is partly open, some F_i of three or more
  /// contacts are: friction over those that press alone would hold more than μ times the force between the blocks.
  void forces(std::span<const double> y, std::span<double> force, std::span<double> bearing) const;
  /// H_ij by rows, N/m per thickness.
  void tangent(std::span<const double> y, std::span<double> h) const;
  /// Whether F is linear in y between two states: the joint is closed all along in both, or open.
  [[nodiscard]] bool is_linear_between(std::span<const double> from, std::span<const double> to) const;

  /// Most points that a stretch of joint has: a block of the highest order, divided.
  static constexpr std::size_t most_points = 32;

 private:
  template <typename OfPoint>
  void for_closed_points(std::span<const double> y, const OfPoint& of_point) const;

  double stiffness_;
  const EdgeDivision* points_;
  bool pulls_;
};

/// Contacts at both ends.
const EdgeDivision& two_ends();

}  // namespace keyblock::contact
