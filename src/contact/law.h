#pragma once
#include <algorithm>
#include <cmath>

#include "contact/detection.h"

namespace keyblock::contact {

/// The potential of one contact in one step, convex in D: a one-sided normal spring with a dashpot (two-sided for a bond
/// in tension) and a shear spring with a dashpot, cut off at the Coulomb bound, which is frozen during a solve. With the
/// displacements x = depth − n·r and u = shear + t·r at the end of the step, x₀ and u₀ at its start, and c = dashpot/Δt:
///
///     N = max(k_n x + c_n (x − max(x₀, 0)), 0)          T = clamp(k_s u + c_s (u − u₀), ±bound)
///     force on block a: N n − T t, on block b the opposite;  bound = μ N_frozen + c L
///
/// Spring and dashpot together are a spring of stiffness k + c about a shifted origin, so everything else sees one spring.
class Spring {
 public:
  struct Constants {
    double normal_stiffness = 0.0, shear_stiffness = 0.0;  ///< N/m per thickness
    double normal_damping = 0.0, shear_damping = 0.0;      ///< dashpot over Δt, N/m per thickness
    double depth = 0.0, shear = 0.0;                       ///< m, x₀ and u₀
    double bound = 0.0;                                    ///< N, largest |T|
    bool tensile = false;                                  ///< the normal spring also pulls
  };
  Spring() = default;
  /// The one spring that spring and dashpot are. Number: of one contact, or of several at once.
  template <typename Number>
  struct Shifted {
    Number normal_stiffness, shear_stiffness;  ///< N/m per thickness
    Number depth, shear;                       ///< m, y and w at D = 0
    /// x_pressed: x₀ where the normal spring acts, else 0.
    static Shifted of(Number k_n, Number k_s, Number c_n, Number c_s, Number x, Number x_pressed, Number u) {
      const Number normal = k_n + c_n, shear = k_s + c_s;
      return {normal, shear, x - c_n * x_pressed / normal, u - c_s * u / shear};
    }
  };
  explicit Spring(const Constants& c)
      : Spring(c,
               Shifted<double>::of(c.normal_stiffness, c.shear_stiffness, c.normal_damping, c.shear_damping,
                                   c.depth, c.tensile ? c.depth : std::max(c.depth, 0.0), c.shear)) {}
  Spring(const Constants& c, const Shifted<double>& s)
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
  [[nodiscard]] double normal_stiffness() const { return normal_; }
  [[nodiscard]] double shear_stiffness() const { return shear_; }
  [[nodiscard]] double depth() const { return depth_; }   ///< y at D = 0
  [[nodiscard]] double shear() const { return origin_; }  ///< w at D = 0
  [[nodiscard]] double bound() const { return bound_; }
  [[nodiscard]] bool tensile() const { return tensile_; }

  [[nodiscard]] bool closed(double y) const { return tensile_ || y > 0.0; }
  [[nodiscard]] bool locked(double w) const { return std::abs(shear_ * w) <= bound_; }
  [[nodiscard]] double normal_force(double y) const { return closed(y) ? normal_ * y : 0.0; }
  [[nodiscard]] double shear_force(double w) const { return std::clamp(shear_ * w, -bound_, bound_); }
  /// Minus the integral of the forces: ∂potential/∂y = N, ∂potential/∂w = T.
  [[nodiscard]] double potential(double y, double w) const {
    const double force = shear_force(w);
    return 0.5 * normal_force(y) * y + std::abs(force) * (std::abs(w) - 0.5 * std::abs(force) / shear_);
  }

  /// x at the end of the step, from y.
  [[nodiscard]] double penetration(double y) const { return y + (start_depth_ - depth_); }
  /// The part of the shear displacement that comes back, from w; the rest has slipped.
  [[nodiscard]] double elastic_shear(double w) const {
    return shear_force(w) / shear_ + (start_shear_ - origin_);
  }

  [[nodiscard]] double stored_at_start() const {
    const bool pressed = tensile_ || start_depth_ > 0.0;
    return 0.5 * (pressed ? elastic_normal_ * start_depth_ * start_depth_ : 0.0) +
           0.5 * elastic_shear_ * start_shear_ * start_shear_;
  }
  /// Where the energy of a contact goes in a step: work of its forces on the blocks + stored − before + friction + damping
  /// + numerical = 0; the last is what end-of-step forces lose against the potential.
  struct Balance {
    double stored = 0.0, friction = 0.0, damping = 0.0, numerical = 0.0;
  };
  [[nodiscard]] Balance balance(double y, double w) const {
    const double x = penetration(y), normal = normal_force(y), shear = shear_force(w),
                 elastic = elastic_shear(w);
    const double x_force = tensile_ || x > 0.0 ? elastic_normal_ * x : 0.0;
    Balance b;
    b.stored = 0.5 * x_force * x;
    if (closed(y)) b.stored += 0.5 * elastic_shear_ * elastic * elastic;  // else shear is forgotten
    b.friction = std::abs(shear) * std::abs(w - shear / shear_);
    b.damping = (normal - x_force) * (x - start_depth_) +
                (shear - elastic_shear_ * elastic) * (elastic - start_shear_);
    const double work = -normal * (y - depth_) - shear * (w - origin_);
    b.numerical = stored_at_start() - work - b.stored - b.friction - b.damping;
    return b;
  }

  /// The same where forces are multipliers, which store nothing: `normal` and `slip` are n·r and t·r of the step.
  [[nodiscard]] Balance rigid_balance(double y, double w, double normal, double slip) const {
    const double shear = closed(y) ? shear_force(w) : 0.0;
    Balance b;
    b.friction = locked(w) ? 0.0 : shear * slip;
    b.numerical = -normal_force(y) * normal + shear_force(w) * slip - b.friction;
    return b;
  }

 private:
  double elastic_normal_ = 0.0, elastic_shear_ = 0.0;  // without the dashpots
  double start_depth_ = 0.0, start_shear_ = 0.0;
  double bound_ = 0.0;
  bool tensile_ = false;
  double normal_ = 0.0, shear_ = 0.0;
  double depth_ = 0.0, origin_ = 0.0;
};

}  // namespace keyblock::contact
