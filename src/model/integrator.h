#pragma once
#include "core/lanes.h"
#include "model/options.h"

namespace keyblock::dynamics {

/// How coefficients of a block move, one in each lane: velocity v, acceleration a, and F, the sum of all forces over the mass, which is
/// a in schemes that balance them at the end of the step.
struct Motion {
  Lanes velocity{}, acceleration{}, force{};
};

/// A rule of time integration in the form that a step needs:
///
///     M (c (D/Δt − v)/Δt − c_a a − c_F F) = force at the end of the step
///
/// with v, a, F at its start. Shi's family with θ (Shi 1988: θ = 1; backward Euler: 0) needs neither a nor F:
///
///     c = 1 + θ,   v′ = (1+θ) D/Δt − θ v
///
/// The generalized-α scheme (Chung & Hulbert 1993) of spectral radius ρ at infinite frequency:
///
///     (1−α_m) a′ + α_m a = (1−α_f) F′ + α_f F,     α_m = (2ρ−1)/(ρ+1),  α_f = ρ/(ρ+1)
///     D = Δt v + Δt² ((½−β) a + β a′),   v′ = v + Δt ((1−γ) a + γ a′),   γ = ½ − α_m + α_f,  β = ¼ (1 − α_m + α_f)²
///
/// and the average-acceleration rule (Newmark 1959, β = ¼, γ = ½) is the same with α_m = α_f = 0.
class Integrator {
 public:
  Integrator() : Integrator(shi(1.0)) {}

  static Integrator shi(double theta) {
    Integrator rule(Family::shi);
    rule.theta_ = theta;
    rule.inertia_ = 1.0 + theta;
    return rule;
  }
  static Integrator average_acceleration() { return newmark(0.0, 0.0); }
  static Integrator generalized_alpha(double radius) {
    return newmark((2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0));
  }

  /// The rule of a scenario.
  static Integrator of(const SolverOptions& options) {
    switch (options.integrator) {
      case TimeIntegration::shi:
        break;
      case TimeIntegration::average_acceleration:
        return average_acceleration();
      case TimeIntegration::generalized_alpha:
        return generalized_alpha(options.spectral_radius);
    }
    return shi(options.theta);
  }

  [[nodiscard]] double inertia() const { return inertia_; }            ///< c
  [[nodiscard]] double acceleration() const { return acceleration_; }  ///< c_a
  [[nodiscard]] double force() const { return force_; }                ///< c_F

  /// ∂v′/∂D, times Δt.
  [[nodiscard]] double end_velocity_share() const {
    return family_ == Family::shi ? 1.0 + theta_ : gamma_ / beta_;
  }

  /// The work of a force over a step is D times this share of the force at its end, and the rest of that at its start. Shi's rule makes D and
  /// v′ of the force at the end alone. The others make v′ − v of forces that are, to second order, those in the middle of the step: the force at
  /// the end would be half a step ahead of D, and what is out of phase with the motion, as that of the ground is, would do wrong work in the
  /// first order of Δt.
  [[nodiscard]] double end_share_of_work() const { return family_ == Family::shi ? 1.0 : 0.5; }

  /// Where in a step, as a share of it, the force is that the rule takes: Shi's rule has the same force all over the step, so that it stands for
  /// the middle; the others balance forces at the end.
  [[nodiscard]] double place_of_force() const { return family_ == Family::shi ? 1.0 - 0.5 * theta_ : 1.0; }

  /// The same of the force of a spring between bodies, of stiffness k and reduced mass m: ratio = k Δt²/m. Where the step resolves its swing, the
  /// spring is not damped by the rule; where it does not, it has the force at the end, and does not ring. By Shi's rule, of Ω² = ratio:
  ///
  ///     q = (2 + Ω²)/(4 + Ω²),   |λ|² = 1/(1 + Ω⁴/(8 + 4 Ω²)),   damping Ω³/16 of critical at small Ω
  ///
  /// (decision 0034).
  [[nodiscard]] double place_of_spring(double ratio) const {
    const double place = place_of_force();
    return place + (1.0 - place) * ratio / (4.0 + ratio);
  }

  /// D of a step with v′ = 0 is this share of Δt v, and the next of Δt² a.
  [[nodiscard]] double rest_share() const {
    return family_ == Family::shi ? theta_ / inertia_ : 1.0 - beta_ / gamma_;
  }
  [[nodiscard]] double rest_share_of_acceleration() const {
    return family_ == Family::shi ? 0.0 : 0.5 - beta_ / gamma_;
  }

  /// The motion at the end of a step of length dt and increment D.
  [[nodiscard]] Motion end(const Motion& start, Lanes d, double dt) const {
    const Lanes jump = (d / dt - start.velocity) / dt;
    Motion m;
    m.force = inertia_ * jump - acceleration_ * start.acceleration - force_ * start.force;
    if (family_ == Family::shi) {
      m.velocity = (1.0 + theta_) * d / dt - theta_ * start.velocity;
      m.acceleration = m.force;
    } else {
      m.acceleration = jump / beta_ - (0.5 / beta_ - 1.0) * start.acceleration;
      m.velocity = start.velocity + dt * ((1.0 - gamma_) * start.acceleration + gamma_ * m.acceleration);
    }
    return m;
  }

 private:
  enum class Family { shi, newmark };
  explicit Integrator(Family family) : family_(family) {}
  static Integrator newmark(double alpha_m, double alpha_f) {
    Integrator rule(Family::newmark);
    rule.gamma_ = 0.5 - alpha_m + alpha_f;
    rule.beta_ = 0.25 * (1.0 - alpha_m + alpha_f) * (1.0 - alpha_m + alpha_f);
    rule.inertia_ = (1.0 - alpha_m) / ((1.0 - alpha_f) * rule.beta_);
    rule.acceleration_ = ((1.0 - alpha_m) * (0.5 / rule.beta_ - 1.0) - alpha_m) / (1.0 - alpha_f);
    rule.force_ = alpha_f / (1.0 - alpha_f);
    return rule;
  }

  Family family_;
  double theta_ = 1.0;
  double beta_ = 0.5, gamma_ = 1.0;
  double inertia_ = 2.0, acceleration_ = 0.0, force_ = 0.0;
};

}  // namespace keyblock::dynamics
