#pragma once
#include <limits>
#include <type_traits>
#include <utility>

#include "core/lanes.h"

namespace keyblock::contact {

/// The law of a spring: force f(e) = clamp(k e, low, high) over its stretch e. It has three branches: the straight lines on which the force is
/// `low`, k e, and `high`; an end of the elastic branch belongs to the branch beside it. Convex potential: low ≤ 0 ≤ high.
///
/// Normal and shear spring of every contact are two of these, and so are the springs of other couplings: what is solved, the open-close
/// iteration and the low-rank update, asks here.
///
/// Number: double, or Lanes for as many springs at once.
template <typename Number>
struct ClampedSpring {
  using Condition = std::remove_cvref_t<decltype(std::declval<Number>() > std::declval<Number>())>;
  Number stiffness{};    ///< k, N/m per thickness
  Number low{}, high{};  ///< N per thickness

  [[nodiscard]] Number force(Number e) const {
    const Number elastic = stiffness * e;
    return where(elastic < low, low, where(high < elastic, high, elastic));
  }
  [[nodiscard]] Condition is_low(Number e) const { return stiffness * e <= low; }
  [[nodiscard]] Condition is_high(Number e) const { return high <= stiffness * e; }
  [[nodiscard]] Condition is_elastic(Number e) const {
    const Number elastic = stiffness * e;
    return (low < elastic) & (elastic < high);
  }
};

/// The normal spring of a contact presses; that of a bond pulls as well.
template <typename Number, typename Condition>
ClampedSpring<Number> normal_spring(Number stiffness, Condition tensile) {
  const Number infinite = Number{} + std::numeric_limits<double>::infinity();
  return {stiffness, where(tensile, -infinite, Number{}), infinite};
}
/// The shear spring holds up to the bound.
template <typename Number>
ClampedSpring<Number> shear_spring(Number stiffness, Number bound) {
  return {stiffness, -bound, bound};
}

/// The potential of one contact in one step, convex in D: a one-sided normal spring with a dashpot (two-sided for a bond
/// in tension) and a shear spring with a dashpot, cut off at the Coulomb bound, which is frozen during a solve. With the
/// displacements x = depth − n·r and u = shear + t·r at the end of the step, x₀ and u₀ at its start, and c = dashpot/Δt:
///
///     N = max(k_n x + c_n (x − max(x₀, 0)), 0)          T = clamp(k_s u + c_s (u − u₀), ±bound)
///     force on block a: N n − T t, on block b the opposite;  bound = max(μ N_frozen + c L, 0)
///
/// Spring and dashpot together are a spring of stiffness k + c about a shifted origin, so everything else sees one spring.
///
/// Number: double, or Lanes for as many contacts at once.
template <typename Number>
class BasicSpring {
 public:
  using Condition = std::remove_cvref_t<decltype(std::declval<Number>() > std::declval<Number>())>;
  struct Constants {
    Number normal_stiffness{}, shear_stiffness{};  ///< N/m per thickness
    Number normal_damping{}, shear_damping{};      ///< dashpot over Δt, N/m per thickness
    Number depth{}, shear{};                       ///< m, x₀ and u₀
    Number bound{};                                ///< N, largest |T|
    Condition tensile{};                           ///< the normal spring also pulls
  };
  /// The one spring that spring and dashpot are.
  struct Shifted {
    Number normal_stiffness, shear_stiffness;  ///< N/m per thickness
    Number depth, shear;                       ///< m, y and w at D = 0
  };
  explicit BasicSpring(const Constants& c) : BasicSpring(c, shifted(c)) {}
  BasicSpring(const Constants& c, const Shifted& s)
      : elastic_normal_(c.normal_stiffness),
        elastic_shear_(c.shear_stiffness),
        start_depth_(c.depth),
        start_shear_(c.shear),
        bound_(c.bound),
        tensile_(c.tensile),
        normal_(s.normal_stiffness),
        shear_(s.shear_stiffness),
        depth_(s.depth),
        origin_(s.shear) {}

  // The one spring: penetration y and shear w about the shifted origin.
  [[nodiscard]] Number normal_stiffness() const { return normal_; }
  [[nodiscard]] Number shear_stiffness() const { return shear_; }
  [[nodiscard]] Number depth() const { return depth_; }   ///< y at D = 0
  [[nodiscard]] Number shear() const { return origin_; }  ///< w at D = 0
  [[nodiscard]] Number bound() const { return bound_; }

  [[nodiscard]] Condition closed(Number y) const { return normal_spring(normal_, tensile_).is_elastic(y); }
  [[nodiscard]] Condition locked(Number w) const { return magnitude(shear_ * w) <= bound_; }
  [[nodiscard]] Number normal_force(Number y) const { return normal_spring(normal_, tensile_).force(y); }
  [[nodiscard]] Number shear_force(Number w) const { return shear_spring(shear_, bound_).force(w); }
  /// Minus the integral of the forces: ∂potential/∂y = N, ∂potential/∂w = T.
  [[nodiscard]] Number potential(Number y, Number w) const {
    const Number force = magnitude(shear_force(w));
    return 0.5 * normal_force(y) * y + force * (magnitude(w) - 0.5 * force / shear_);
  }

  /// x at the end of the step, from y.
  [[nodiscard]] Number penetration(Number y) const { return y + (start_depth_ - depth_); }
  /// The part of the shear displacement that comes back, from w; the rest has slipped.
  [[nodiscard]] Number elastic_shear(Number w) const {
    return shear_force(w) / shear_ + (start_shear_ - origin_);
  }

  [[nodiscard]] Number stored_at_start() const {
    const Condition pressed = tensile_ | (start_depth_ > zero);
    return 0.5 * where(pressed, elastic_normal_ * start_depth_ * start_depth_, zero) +
           0.5 * elastic_shear_ * start_shear_ * start_shear_;
  }
  /// Where the energy of a contact goes in a step: work of its forces on the blocks + stored − before + friction + damping
  /// + numerical = 0; the last is what end-of-step forces lose against the potential.
  struct Balance {
    Number stored{}, friction{}, damping{}, numerical{};
  };
  /// slipped: m, slip of the step that w does not have. Where the shear force comes to act along it, it is no friction. holds: the contact is
  /// closed by more than its own normal spring.
  [[nodiscard]] Balance balance(Number y, Number w, Number slipped = Number(),
                                Condition holds = Condition()) const {
    const Number x = penetration(y), normal = normal_force(y), shear = shear_force(w),
                 elastic = elastic_shear(w);
    const Number x_force = where(tensile_ | (x > zero), elastic_normal_ * x, zero);
    Balance b;
    b.stored = 0.5 * x_force * x + where(closed(y) | holds, 0.5 * elastic_shear_ * elastic * elastic,
                                         zero);  // else shear is forgotten
    b.friction = magnitude(shear) * magnitude(w - shear / shear_) +
                 where(shear * slipped > zero, shear * slipped, zero);
    b.damping = (normal - x_force) * (x - start_depth_) +
                (shear - elastic_shear_ * elastic) * (elastic - start_shear_);
    const Number work = -normal * (y - depth_) - shear * (w + slipped - origin_);
    b.numerical = stored_at_start() - work - b.stored - b.friction - b.damping;
    return b;
  }

 private:
  static constexpr Number zero{};
  static Number magnitude(Number x) { return where(x < zero, -x, x); }
  static Shifted shifted(const Constants& c) {
    const Number normal = c.normal_stiffness + c.normal_damping, shear = c.shear_stiffness + c.shear_damping,
                 pressed = where(c.tensile | (c.depth > zero), c.depth, zero);
    return {normal, shear, c.depth - c.normal_damping * pressed / normal,
            c.shear - c.shear_damping * c.shear / shear};
  }

  Number elastic_normal_{}, elastic_shear_{};  // without the dashpots
  Number start_depth_{}, start_shear_{};
  Number bound_{};
  Condition tensile_{};
  Number normal_{}, shear_{};
  Number depth_{}, origin_{};
};

/// N, μ N + c L: the largest shear force (Coulomb 1776). A bond in tension, N < 0, has less than its cohesion, at the least none.
///
/// Number: double, or Lanes for as many contacts at once.
template <typename Number>
Number shear_strength(Number friction, Number normal, Number cohesion) {
  const Number zero{}, strength = friction * normal + cohesion;
  return where(strength > zero, strength, zero);
}

using Spring = BasicSpring<double>;
using SpringLanes = BasicSpring<Lanes>;

}  // namespace keyblock::contact
