#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "statistics/interval.h"

/// Curves that show a sample and how sure it is.
namespace keyblock::statistics {

/// The mean of the first n values of a sample in its order, and its band x̄_n ± t s_n/√n, t of Student's distribution
/// with n − 1 degrees of freedom. The mean has settled when the band is as narrow as the question needs.
struct RunningMean {
  std::vector<std::size_t> n;
  std::vector<Estimate> mean;  ///< the band is not a number at n = 1
};

/// At most `points` values of n, evenly, 1 and the last among them.
RunningMean running_mean(std::span<const double> sample, double confidence, std::size_t points = 200);

/// The share of a sample above v, P(X > v) = #{x_i > v}/n: a staircase that goes down at every value of the sample.
/// `above[k]` holds from value[k] up to the next value; below value[0] it is 1. The band is Wilson's, for each v by itself.
struct ExceedanceCurve {
  std::vector<double> value;  ///< ascending, without repetition
  std::vector<Estimate> above;
};

/// At most about `points` steps, those at evenly spaced ranks, first and last among them.
ExceedanceCurve exceedance_curve(std::span<const double> ascending, double confidence,
                                 std::size_t points = 200);

}  // namespace keyblock::statistics
