#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "statistics/bootstrap.h"
#include "statistics/interval.h"
#include "statistics/two_way.h"

/// Fragility: the probability P(x) that damage exceeds a level under shaking of intensity x, as a lognormal curve
///
///   P(x) = Φ(ln(x/θ)/β)      θ: median, the intensity with P = ½;  β: logarithmic standard deviation
///
/// fitted by maximum likelihood: n_j runs at intensity x_j, of which z_j exceed the level,
///
///   ln L = Σ_j z_j ln P(x_j) + (n_j − z_j) ln(1 − P(x_j))
///
/// (Shinozuka, Feng, Lee & Naganuma 2000, "Statistical analysis of fragility curves"; Baker 2015, "Efficient analytical
/// fragility function fitting using dynamic structural analysis", eq. 11).
namespace keyblock::statistics {

/// All runs at one intensity.
struct Stripe {
  double intensity = 0.0;
  double runs = 0.0;      ///< n_j
  double exceeded = 0.0;  ///< z_j
  double clusters = 0.0;  ///< of how many clusters (Observation) they are; the fit does not need it
};

enum class FragilityStatus {
  fitted,
  no_data,          ///< no run with an intensity above zero
  one_intensity,    ///< all runs at the same intensity: a point, no curve
  never_exceeded,   ///< z = 0 everywhere
  always_exceeded,  ///< z = n everywhere
  separated,  ///< at most one intensity has a share other than 0 and 1, with none exceeded below it and all above: L goes
  ///< to its bound as β → 0, with θ at that intensity, or anywhere between the last of none and the first of all
  not_increasing,  ///< more shaking does not go with more damage: the likeliest curve is flat or falls
  /// The fit stands, or does not matter, but it is no curve to be shown (FragilityLimits):
  exceeded_at_rest,  ///< too many exceed the level without shaking, where P(0) = 0
  too_few_clusters,  ///< fewer than smallest_bootstrap_sample: nobody knows how sure θ and β are
  few_fits,          ///< without one of the rock masses or records there is none: it hangs on that one
  wide_theta,        ///< the interval of θ spans too much
  wide_beta,         ///< the interval of β does
};

const char* name_of(FragilityStatus status);

struct FragilityFit {
  FragilityStatus status = FragilityStatus::no_data;
  /// fitted; separated: geometric mean of its bounds; ∞ never, 0 always exceeded; not_increasing: ∞ where fewer than half
  /// exceed the level, 0 where more do.
  double theta = not_a_number;
  double beta = not_a_number;   ///< fitted; separated: 0; not_increasing: ∞
  double share = not_a_number;  ///< Σ z / Σ n
  /// The likeliest curve that does not fall: for what is not fitted, a step or a constant. Not a number without data
  /// or at one intensity.
  [[nodiscard]] double probability(double intensity) const;
};

/// Stripes of intensity above zero, ascending; empty ones (runs = 0) are passed over. With η = a + b ln x, b = 1/β and
/// θ = exp(−a/b), ln L is concave; Fisher scoring with step halving finds its maximum from any start.
FragilityFit fit_fragility(std::span<const Stripe> stripes);

/// A run, as seen by a fragility curve.
struct Observation {
  double intensity = 0.0;
  bool exceeded = false;
  int cluster = 0;  ///< the realization: the same rock at all intensities, hence not independent
  int record = 0;   ///< the earthquake: the same for many rock masses, hence not independent either
};

/// Beyond these a fit is no curve to be shown. Why so: docs/study-report.md.
struct FragilityLimits {
  double widest_theta = 4.0;    ///< upper over lower end of the interval of θ
  double widest_beta = 4.0;     ///< the same of β
  double share_at_rest = 0.05;  ///< of the runs without shaking that exceed the level
};

/// What of β² is from rock to rock, from record to record, and of the single pair (split.h). Each may come out below zero, where it
/// is small: it is 0 then, with its interval. Intervals are by rock masses and records alone, on the safe side.
struct Split {
  Estimate rock, record, rest;  ///< σ
};
/// A split of fewer than these says hardly anything.
inline constexpr std::size_t smallest_split_rocks = 20, smallest_split_records = 8;
/// Fewer records than these give intervals that are wide for want of records.
inline constexpr std::size_t few_records = 5;

/// Fits without one rock mass, one record, one pair.
struct FragilityRefits {
  std::vector<FragilityFit> rocks, records, pairs;
  /// A number of each of them.
  template <class Of>
  [[nodiscard]] LeftOut numbers(const Of& of) const {
    const auto each = [&](const std::vector<FragilityFit>& fits) {
      std::vector<double> found;
      for (const FragilityFit& fit : fits) found.push_back(of(fit));
      return found;
    };
    return {each(rocks), each(records), each(pairs)};
  }
};

/// The fit with its band, by the two-way jackknife (two_way.h): intervals of ln θ, of ln β, and at each x of (ln x − ln θ)/β. With one
/// record they are for this record alone. Where all runs together give no fit, or with fewer than smallest_bootstrap_sample rock masses,
/// there is neither band nor interval.
struct FragilityCurve {
  FragilityFit fit;
  FragilityStatus status =
      FragilityStatus::no_data;  ///< that of the fit, or why this is no curve to be shown
  Estimate theta, beta;          ///< of the fit, where its status is fitted; otherwise not a number
  std::vector<Stripe> stripes;
  Stripe at_rest;                     ///< the runs without shaking: ln 0 is no place on the curve
  std::vector<double> intensity;      ///< as asked for; empty unless `status` is fitted
  std::vector<Estimate> probability;  ///< there, pointwise band
  std::size_t clusters = 0, records = 0;
  FragilityRefits refits;
  Split split;  ///< no numbers: too few rock masses or records, or pairs that lack an intensity
  /// Pairs that exceed the level at an intensity and not at a stronger one, of `pairs`.
  std::size_t not_monotone = 0, pairs = 0;
};

FragilityCurve fragility_curve(std::span<const Observation> runs, std::span<const double> at,
                               double confidence, const FragilityLimits& limits = {});

}  // namespace keyblock::statistics
