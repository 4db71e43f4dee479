#pragma once
#include <cstddef>
#include <span>

#include "statistics/interval.h"

/// How much of what is found hangs on what was put in: x_i and y_i of realizations i = 1 … n.
namespace keyblock::statistics {

/// Realizations below which no first-order index is given.
inline constexpr std::size_t smallest_index_sample = 20;

/// Spearman's rank correlation ρ: that of the ranks, equal values having the mean of theirs. The interval is that of Fisher's z,
///
///     z = atanh ρ ± z_c √((1 + ρ²/2)/(n − 3))
///
/// (Bonett & Wright 2000, "Sample size requirements for estimating Pearson, Kendall and Spearman correlations"), z_c the normal quantile of the
/// confidence. Not a number where all x or all y are equal; no interval for n < 4.
Estimate rank_correlation(std::span<const double> x, std::span<const double> y, double confidence);

/// First-order index S = Var(E(y|x))/Var(y), the share of the variance of y that x alone explains (Sobol 1993), from given data: a correlation
/// ratio. x is divided into M classes of equal size, M = n/16 within 1 … 6, and a straight line is fitted in each; with the sum of squares about the lines,
///
///     S = 1 − (n − 1)/(n − 2M) Σ (y − line)² / Σ (y − ȳ)².
///
/// The lines take away the bias that means of classes have where x explains nearly all; the degrees of freedom that where it explains nothing. The
/// interval is that of a jackknife over 20 groups (Quenouille 1956; Wolter 2007, "Introduction to Variance Estimation", ch. 4): every 20th
/// realization is left out in turn, and S ± t s_J, t of Student's distribution with 19 degrees of freedom. All three are cut to 0 … 1.
/// Not a number for fewer than smallest_index_sample, or where all x or all y are equal.
Estimate first_order_index(std::span<const double> x, std::span<const double> y, double confidence);

}  // namespace keyblock::statistics
