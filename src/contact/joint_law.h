#pragma once
#include <algorithm>
#include <cmath>
#include <optional>

namespace keyblock::contact {

/// What a joint bears at a time: shear up to μN + cL (Coulomb 1776), and tension up to σ_t L.
struct Strength {
  double friction_coefficient = 0.0;     ///< μ
  double cohesion = 0.0, tension = 0.0;  ///< c, σ_t; Pa, of a joint in place
};

/// What strength loses from now on: in a straight line over a slip, or at once where that is 0.
struct StrengthLoss {
  double slip = 0.0;      ///< m
  double friction = 0.0;  ///< of the friction coefficient, in all
  double cohesion = 0.0;  ///< in all; Pa of a joint, N per thickness of a contact

  [[nodiscard]] bool is_any() const { return friction != 0.0 || cohesion != 0.0; }
  /// What is lost after so much more slip.
  [[nodiscard]] StrengthLoss after(double more) const {
    const double share = more < slip ? more / slip : 1.0;
    return {share * slip, share * friction, share * cohesion};
  }
};

/// The law of a joint, per edge label. Stiffness is that of the pair of blocks where it is not given.
///
/// A plain joint keeps its friction. Its cohesion and tension are those of a bond: a contact in place has them until it slips or opens. A joint
/// with residual strength falls from peak to residual strength over a slip, with w the slip that has worn it and d_c the weakening slip,
///
///     μ = μ_r + (μ_p − μ_r) f     c = c_r + (c_p − c_r) f     σ_t = σ_p f     f = max(0, 1 − w/d_c)
///
/// and with d_c = 0 when it first slips. It keeps cohesion until it opens. c_r = c_p and μ_r = μ_p is ideal plasticity. What was never in place, or
/// is not known to have been (JointPieces), has residual friction and no cohesion. Nobody else evaluates the strength of a joint.
struct JointLaw {
  /// What is left of strength at the end.
  struct Residual {
    double friction_coefficient = 0.0;  ///< μ_r, no more than the peak
    double cohesion = 0.0;              ///< c_r, Pa, no more than the peak
    double slip = 0.0;                  ///< d_c, m
    friend bool operator==(const Residual&, const Residual&) = default;
  };
  /// m: more than any joint slips; w of a joint with nothing left to lose.
  static constexpr double worn_out = 1e9;

  double friction_coefficient = 0.0;  ///< of the peak
  double cohesion = 0.0;              ///< Pa, of the peak; of contacts in place
  double tension = 0.0;               ///< Pa, likewise
  double normal_stiffness = 0.0;      ///< Pa/m; 0: [solver] penalty × E, of the softer of the two blocks
  double stiffness_ratio = 0.4;       ///< shear over normal
  bool fused = false;  ///< an outline of an excavation not yet opened: rock on both sides is one
  std::optional<Residual> residual{};  ///< none: the joint is plain

  friend bool operator==(const JointLaw&, const JointLaw&) = default;
  /// Whether contacts in place are bonded: they have something that slip or opening takes for good.
  [[nodiscard]] bool may_bond() const {
    return fused || cohesion > 0.0 || tension > 0.0 || (residual && residual->slip == 0.0);
  }
  /// Whether slip or opening may take something for good.
  [[nodiscard]] bool may_break() const { return !fused && (may_bond() || residual); }
  /// Whether slip takes something of what a joint in place bears.
  [[nodiscard]] bool may_wear() const {
    return residual && (residual->friction_coefficient < friction_coefficient ||
                        residual->cohesion < cohesion || tension > 0.0);
  }
  /// Whether what a joint bears depends on how far it has slipped.
  [[nodiscard]] bool has_memory() const { return residual.has_value() && !fused; }
  /// f, share of peak strength left after a slip of w.
  [[nodiscard]] double share_left(double worn) const {
    if (!residual || worn <= 0.0) return 1.0;
    return worn < residual->slip ? 1.0 - worn / residual->slip : 0.0;
  }
  /// Share that is left of what slip and opening may take; 1 where that is nothing. A joint that has opened has no cohesion any more; of its
  /// friction it has what slip has left.
  [[nodiscard]] double strength_left(double worn, bool bonded) const {
    const bool friction_falls = residual && residual->friction_coefficient < friction_coefficient;
    if (may_break() && may_bond() && !bonded && !friction_falls) return 0.0;
    return has_memory() && may_wear() ? share_left(worn) : 1.0;
  }
  /// bonded: of a joint in place that has not opened.
  [[nodiscard]] Strength strength(double worn, bool bonded) const;
  /// What is lost from w on.
  [[nodiscard]] StrengthLoss loss(double worn, bool bonded) const;
  /// With tan φ, c and σ_t, at the peak and at the end, over a factor. A factor of 1 keeps every bit.
  [[nodiscard]] JointLaw divided_by(double factor) const {
    JointLaw law = *this;
    law.friction_coefficient /= factor;
    law.cohesion /= factor;
    law.tension /= factor;
    if (!law.residual) return law;
    law.residual->friction_coefficient /= factor;
    law.residual->cohesion /= factor;
    return law;
  }
  /// Whether a bond holds on when it slips.
  [[nodiscard]] bool is_ductile(double worn) const {
    return has_memory() && (residual->slip > 0.0 || worn > 0.0);
  }
};

inline Strength JointLaw::strength(double worn, bool bonded) const {
  const double share = share_left(worn);
  Strength now{friction_coefficient, bonded ? cohesion : 0.0, bonded ? tension : 0.0};
  if (share == 1.0) return now;
  now.friction_coefficient = std::lerp(residual->friction_coefficient, friction_coefficient, share);
  if (bonded) now.cohesion = std::lerp(residual->cohesion, cohesion, share);
  now.tension *= share;
  return now;
}

inline StrengthLoss JointLaw::loss(double worn, bool bonded) const {
  const double share = share_left(worn);
  if (!residual || share == 0.0) return {};
  return {share * residual->slip, share * (friction_coefficient - residual->friction_coefficient),
          bonded ? share * (cohesion - residual->cohesion) : 0.0};
}

/// Between the law of an edge and that of the edge beyond its end, which has `share` of the length of the contact. What is fused is so to its
/// end. penalty: Pa/m, normal stiffness of a joint that gives none.
inline JointLaw mixed(const JointLaw& law, const JointLaw& beyond, double share, double penalty) {
  const auto stiffness = [&](const JointLaw& of) {
    return of.normal_stiffness > 0.0 ? of.normal_stiffness : penalty;
  };
  const auto between = [&](double of_law, double of_beyond) { return std::lerp(of_law, of_beyond, share); };
  JointLaw both = law;
  both.friction_coefficient = between(law.friction_coefficient, beyond.friction_coefficient);
  both.cohesion = between(law.cohesion, beyond.cohesion);
  both.tension = between(law.tension, beyond.tension);
  both.normal_stiffness = between(stiffness(law), stiffness(beyond));
  both.stiffness_ratio =
      between(stiffness(law) * law.stiffness_ratio, stiffness(beyond) * beyond.stiffness_ratio) /
      both.normal_stiffness;
  if (law.residual || beyond.residual) {
    const auto residual_of = [](const JointLaw& of) {
      return of.residual.value_or(JointLaw::Residual{of.friction_coefficient, 0.0, 0.0});
    };
    const JointLaw::Residual first = residual_of(law), second = residual_of(beyond);
    both.residual =
        JointLaw::Residual{between(first.friction_coefficient, second.friction_coefficient),
                           between(first.cohesion, second.cohesion), between(first.slip, second.slip)};
  }
  return both;
}

}  // namespace keyblock::contact
