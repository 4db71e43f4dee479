#pragma once
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "geometry/vec2.h"

namespace keyblock::loading {

/// A rock bolt. Forces and stiffness are those of one bolt; one per `spacing` out of plane stands in a section.
struct Bolt {
  std::string name;                      ///< of this one
  std::string list;                      ///< of the [[bolt]] that it is of: stages install all of these
  int staged = -1;                       ///< State::installed that says whether it is there; −1: always
  Vec2 head, toe;                        ///< at the wall, and deep in the rock; in reference position
  double spacing = 1.0;                  ///< m, out of plane
  double area = 0.0;                     ///< m², of the bar
  double young = 210e9;                  ///< Pa
  std::optional<double> yield;           ///< N; empty: it never yields
  std::optional<double> rupture_strain;  ///< plastic strain at which the bar breaks; empty: it never does
  bool is_anchored = false;              ///< held at both ends, and by nothing between
  bool has_nodes = false;                ///< it is a chain of nodes, whose grout slips along it
  std::optional<double> node_spacing;    ///< m, between its nodes at the most; empty: by its grout
  bool has_plate = true;                 ///< at the head
  double pretension = 0.0;               ///< N
  double grout_stiffness = 0.0;          ///< N/m per m of bolt
  std::optional<double> grout_strength;  ///< N per m of bolt; empty: it never slips
  std::pair<double, double> grouted{};   ///< m from the head
  double active_length = 0.0;            ///< m, of the bar that yields and turns at a joint
  double dowel_stiffness = 0.0;          ///< N/m, across the bolt, at each joint; 0: none
  std::optional<double> dowel_strength;  ///< N; empty: it never yields

  [[nodiscard]] double length() const { return norm(toe - head); }
  [[nodiscard]] double diameter() const { return std::sqrt(4.0 * area / std::numbers::pi); }
  /// EA, N.
  [[nodiscard]] double bar() const { return young * area; }
};

/// The part of a bolt on one side of a joint that opens, from there to the end of the bolt: at first a free length, then grout with slip w against
/// the bar of
///
///     EA w″ = k_b w,   k_b w ≤ s_b       α = √(k_b/EA),   w_y = s_b/k_b
///
/// Where a length l next to the joint slips, the bar is pulled by P(l) and comes out by u(l):
///
///     P = P_e + s_b l,   u = w_y + (P_e l + s_b l²/2)/EA + f P/EA,   P_e = EA α w_y tanh α(L − l)
///
/// with the grouted length L and the free length f. A plate at the end holds the bar there: coth in the place of tanh. (Farmer 1975; Li & Stillborg
/// 1999.)
class BoltSide {
 public:
  BoltSide(const Bolt& bolt, double free_length, double grouted_length, bool has_plate)
      : bolt_(&bolt), free_(free_length), grouted_(grouted_length), has_plate_(has_plate) {}

  /// N, largest force that it holds; 0: nothing holds it.
  [[nodiscard]] double capacity() const;
  /// m, by which the bar comes out where a force, N, pulls it, which is at most the capacity.
  [[nodiscard]] double displacement(double force) const;

 private:
  [[nodiscard]] bool is_grouted() const { return grouted_ > 0.0 && bolt_->grout_stiffness > 0.0; }
  [[nodiscard]] double strength() const {
    return bolt_->grout_strength.value_or(std::numeric_limits<double>::infinity());
  }
  /// tanh or coth of α x.
  [[nodiscard]] double hold(double x) const;
  [[nodiscard]] double grout_displacement(double force) const;

  const Bolt* bolt_;
  double free_, grouted_;
  bool has_plate_;
};

/// A bolt at a joint: the spring that its two sides are in series. Its stiffness is the secant at capacity.
struct BoltAtJoint {
  double stiffness = 0.0;  ///< N/m
  double capacity = 0.0;   ///< N; infinite: none. 0: a side is held by nothing
};
[[nodiscard]] BoltAtJoint bolt_at_joint(const Bolt& bolt, const BoltSide& head, const BoltSide& toe);

}  // namespace keyblock::loading
