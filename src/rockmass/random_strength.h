#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rockmass/joint_set.h"
#include "rockmass/trace.h"

/// Strengths of joints that differ from trace to trace.
namespace keyblock::rockmass {

/// In the order of their draws.
enum class StrengthKey : std::uint8_t { friction, cohesion, tension, residual_friction, residual_cohesion };
inline constexpr std::size_t strength_count = 5;
/// As keys of a scenario and as columns of trace maps.
inline constexpr std::array<const char*, strength_count> strength_names{
    "friction", "cohesion", "tension", "residual_friction", "residual_cohesion"};
inline constexpr std::array<const char*, strength_count> strength_units{"°", "Pa", "Pa", "°", "Pa"};

/// °, above which no friction angle is drawn.
inline constexpr double most_friction = 89.0;
inline constexpr bool is_friction(StrengthKey key) {
  return key == StrengthKey::friction || key == StrengthKey::residual_friction;
}

/// Strengths of a trace by StrengthKey: ° or Pa. What is not there is that of the set or map.
using TraceStrength = std::array<std::optional<double>, strength_count>;

/// What has one value of its own.
enum class DrawnPer : std::uint8_t {
  joint,       ///< each trace, along all of it
  line,        ///< all traces of a set that lie on one line
  realization  ///< all traces of a set or map
};

/// A strength that is drawn, cut off at both ends and scaled to 1 again: with F₀ the distribution without the cut (distribution.h),
///
///     F(x) = (F₀(x) − F₀(min)) / (F₀(max) − F₀(min)),   min ≤ x ≤ max.
struct RandomStrength {
  Distribution distribution;  ///< mean and std before the cut
  double min = 0.0, max = HUGE_VAL;
  DrawnPer per = DrawnPer::joint;

  /// F₀(max) − F₀(min)
  [[nodiscard]] double kept() const;
  /// x with F(x) = u, 0 < u < 1, to 40 binary digits: the last bits of a machine's logarithms do not show. Precondition: kept() > 0.
  [[nodiscard]] double quantile(double u) const;
  /// ∫ x dF, by the midpoint rule over u
  [[nodiscard]] double truncated_mean() const;
};

/// Which realization it is, and over how many of them what is drawn once in each is stratified.
struct Sampling {
  std::uint64_t seed = 0;
  int realization = 0;
  /// N of a Latin hypercube (McKay, Beckman & Conover 1979): of the N realizations 0 … N − 1 one has its u in each of the N intervals
  /// (k/N, (k + 1)/N). 0, and for realizations from N on: all are independent.
  int strata = 0;
};

/// u in (0, 1) of a strength of a trace. It depends on seed, realization, set or map, strength, and on the trace as `per` says: on its line, its
/// interval on the line, or on nothing more. So neither geometry nor other strengths move with it. A residual strength has the u of its
/// peak: the stronger a joint, the more is left, and with the same distribution slip takes nothing.
///
/// With strata, of DrawnPer::realization: u = (π(r) + u')/N, with u' the u without strata, r the realization and π a permutation of 0 … N − 1 that
/// depends on seed, N, set or map and strength alone.
double uniform_of(const Sampling& sampling, const Trace& trace, StrengthKey key, DrawnPer per);

}  // namespace keyblock::rockmass
