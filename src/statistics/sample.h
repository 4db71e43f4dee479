#pragma once
#include <span>

/// Numbers that describe a sample x_1 … x_n. Sums are of the differences to x_1: equal values have that value as their mean, and a
/// standard deviation of exactly 0.
namespace keyblock::statistics {

/// x̄ = Σ x_i / n; not a number when n = 0.
double mean(std::span<const double> sample);

/// s = √(Σ (x_i − x̄)² / (n − 1)); not a number when n < 2.
double standard_deviation(std::span<const double> sample);

/// Quantile of an ascending sample, 0 ≤ p ≤ 1: linear between order statistics (type 7 of Hyndman & Fan 1996, "Sample
/// quantiles in statistical packages"), what R, NumPy and spreadsheets give:
///
///   h = (n − 1) p,   Q(p) = x_⌊h⌋ + (h − ⌊h⌋) (x_⌊h⌋+1 − x_⌊h⌋),   counted from 0.
///
/// Not a number when n = 0.
double quantile(std::span<const double> ascending, double p);

}  // namespace keyblock::statistics
