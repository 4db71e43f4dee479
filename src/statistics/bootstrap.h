#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "statistics/interval.h"

/// Confidence intervals by resampling (Efron & Tibshirani 1993, "An introduction to the bootstrap").
namespace keyblock::statistics {

inline constexpr std::size_t usual_resamples = 1000;
/// Resamples of fewer values than this hardly differ from the sample, and their intervals are far too narrow: none are given.
inline constexpr std::size_t smallest_bootstrap_sample = 5;
/// Key of the random numbers: the same sample gives the same interval on every rerun and machine.
inline constexpr std::uint64_t bootstrap_key = 1979;

/// `count` draws of n out of n with replacement, as ascending ranks. They depend on n and count alone (counter-based
/// random numbers), so that samples of one size share them: statistics of a resample of an ascending sample need no
/// sorting.
class Resamples {
 public:
  explicit Resamples(std::size_t n, std::size_t count = usual_resamples);
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::span<const std::uint32_t> ranks(std::size_t resample) const {
    return std::span(ranks_).subspan(resample * n_, n_);
  }

 private:
  std::size_t n_, count_;
  std::vector<std::uint32_t> ranks_;
};

/// The quantiles (1 ∓ confidence)/2 of the replicates, which are sorted in place. Infinite replicates are allowed;
/// none, or one that is not a number, gives no interval.
Interval percentile_interval(std::vector<double>& replicates, double confidence);

/// Bias-corrected and accelerated (Efron 1987, "Better bootstrap confidence intervals"): the quantiles Φ(z_0 + (z_0 + z)/
/// (1 − a (z_0 + z))) of the replicates, where z is the normal quantile of (1 ∓ confidence)/2, Φ(z_0) the share of replicates
/// below the estimate (equal ones count half) and a = Σ d³ / (6 (Σ d²)^{3/2}), d = mean(θ_(i)) − θ_(i) of the values
/// θ_(i) with sample i left out. Where z_0 or a is not defined, the percentile interval. Sorts the replicates.
Interval bca_interval(std::vector<double>& replicates, double estimate, std::span<const double> left_out,
                      double confidence);

/// A sample in numbers. Mean and standard deviation have BCa intervals, quantiles percentile intervals.
struct Description {
  std::size_t n = 0;
  Estimate mean, standard_deviation;
  std::vector<Estimate> quantiles;  ///< as asked for
  double min = not_a_number, max = not_a_number;
};

/// `ascending` has the size that `resamples` is for. Intervals need n ≥ smallest_bootstrap_sample.
Description describe(std::span<const double> ascending, std::span<const double> probabilities,
                     const Resamples& resamples, double confidence);

}  // namespace keyblock::statistics
