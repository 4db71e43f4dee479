#pragma once
#include <cstddef>

#include "statistics/interval.h"

namespace keyblock::statistics {

/// p = k/n with Wilson's score interval (Wilson 1927; recommended by Brown, Cai & DasGupta 2001, "Interval estimation
/// for a binomial proportion"), z the normal quantile of the confidence:
///
///   (p + z²/2n ± z √(p(1 − p)/n + z²/4n²)) / (1 + z²/n).
///
/// It lies within [0, 1] and is meaningful at k = 0 and k = n. n = 0: p is not a number, the interval [0, 1].
Estimate proportion(std::size_t k, std::size_t n, double confidence);

/// The same of a share p that n independent draws tell of, where p was counted over more than these: n may be smaller than
/// the count, and p · n need not be whole.
Estimate share_of_independent(double p, double n, double confidence);

}  // namespace keyblock::statistics
