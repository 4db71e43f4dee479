#pragma once
#include <span>

#include "statistics/interval.h"

namespace keyblock::statistics {

/// Interval of the quantile p of what an ascending sample was drawn from, by two of its values (David & Nagaraja 2003, "Order
/// Statistics", section 7.1). With B of the binomial distribution of n and p, counted from 1:
///
///   low = x_l, the largest l with P(B < l) ≤ (1 − confidence)/2;   high = x_u, the smallest u with P(B ≥ u) ≤ (1 − confidence)/2.
///
/// It supposes nothing of the distribution, and holds the quantile at least as often as `confidence` says. Infinite on a side on which
/// the sample is too small: at 95 %, for the median, below six values.
Interval quantile_interval(std::span<const double> ascending, double p, double confidence);

}  // namespace keyblock::statistics
