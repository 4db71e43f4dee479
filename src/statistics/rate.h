#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

/// How often a year a level of damage is exceeded: a hazard curve times a fragility curve.
///
///   λ = ∫ P(x) |dλ_h(x)|,     P(x) = Φ(ln(x/θ)/β)
///
/// λ_h(x): how often a year shaking exceeds the intensity x. It is straight between its points in the logarithms of both. Then the integral
/// of a piece from x_i to x_{i+1} of slope k = −ln(λ_{i+1}/λ_i)/ln(x_{i+1}/x_i) is, with z = ln(x/θ)/β,
///
///   Δλ = P_i λ_i − P_{i+1} λ_{i+1} + λ_i (θ/x_i)^{−k} e^{k²β²/2} [Φ(z_{i+1} + kβ) − Φ(z_i + kβ)]
///
/// without any error of quadrature (by parts; of a power law from end to end: Cornell, Jalayer, Hamburger & Foutch 2002).
namespace keyblock::statistics {

struct HazardCurve {
  std::vector<double> intensity;  ///< ascending, above 0; at least two
  std::vector<double> rate;       ///< a year, > 0, descending
  /// Beyond it nothing is expected: the first point of rate 0, where there is one.
  std::optional<double> end = {};

  /// By the pieces, and by the first and the last of them beyond.
  [[nodiscard]] double rate_at(double x) const;
  /// −d ln λ/d ln x of the piece that x is on.
  [[nodiscard]] double slope_at(double x) const;
  [[nodiscard]] double first() const { return intensity.front(); }
  [[nodiscard]] double last() const { return intensity.back(); }
};

/// P(x) of a lognormal curve.
struct Lognormal {
  double theta, beta;
  [[nodiscard]] double operator()(double x) const;
};

/// Parts of a rate by where their shaking is.
struct Rate {
  double inside = 0.0;       ///< between the ends of the hazard curve
  double below = 0.0;        ///< below its first point, where it goes on with its first slope
  double beyond_low = 0.0;   ///< beyond its last point at least: P(x_n) λ_n
  double beyond_high = 0.0;  ///< at most: λ_n; where the hazard has an end x_e, P(x_e) λ_n
  /// With the middle of what lies beyond.
  [[nodiscard]] double total() const { return below + inside + 0.5 * (beyond_low + beyond_high); }
};
Rate annual_rate(const HazardCurve& hazard, const Lognormal& fragility);

/// The part of annual_rate from shaking below x. Beyond the last point: all but what lies beyond it.
double rate_up_to(const HazardCurve& hazard, const Lognormal& fragility, double x);

/// Where `up_to`, which does not fall, comes to `wanted` between two intensities.
double intensity_where(const std::function<double(double)>& up_to, double wanted, double from, double to);

/// Beside the curve: P(x) or the mean of a measure is known at intensities alone. Between them it is straight in ln x.
struct KnownPoints {
  std::vector<double> intensity, value;  ///< ascending intensities
};

/// ∫ m(x) |dλ_h| of the points.
struct PointsRate {
  double between = 0.0;     ///< from the weakest to the strongest
  double beyond_low = 0.0;  ///< from stronger shaking, where the value stays that of the strongest
  /// From weaker shaking: a power law through the two weakest, m₁ (x/x₁)^q, to where the hazard curve goes on with its first slope. No number where q is not
  /// above the slope of the hazard: it has no end then.
  double below = 0.0;
};
PointsRate rate_of_points(const HazardCurve& hazard, const KnownPoints& points);

/// σ of capacities: see split.h.
struct Scatter {
  double rock, record, rest;
};

/// A structure keeps its rock while earthquakes come and go, and is as it was after each of them. Of rock masses of capacity θ e^G, G normal with σ_rock,
/// λ(G) is that of β = √(σ_record² + σ_rest²).
struct Lifetime {
  double probability = 0.0;  ///< E_G[1 − e^{−λ(G) T}]
  double poisson = 0.0;      ///< 1 − e^{−λT} of the mean rate, which is larger (Der Kiureghian 2005)
  double p05 = 0.0, p50 = 0.0, p95 = 0.0;  ///< quantiles of λ(G) over rock masses, a year
};
Lifetime over_lifetime(const HazardCurve& hazard, double theta, const Scatter& scatter, double years);

/// How often a year at least one of n sections exceeds the level. All have the same earthquakes, and rock of their own:
///
///   λ_n = ∫ E_R[1 − (1 − p(x|R))ⁿ] |dλ_h|,     p of median θ e^R and β = √(σ_rock² + σ_rest²)
double rate_of_sections(const HazardCurve& hazard, double theta, const Scatter& scatter, double n);

}  // namespace keyblock::statistics
