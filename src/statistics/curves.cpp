#include "statistics/curves.h"

#include <algorithm>
#include <cmath>

#include "statistics/distributions.h"
#include "statistics/proportion.h"

namespace keyblock::statistics {

namespace {

/// Of n things, which of at most `points` evenly spaced ones comes k-th.
std::size_t spaced(std::size_t k, std::size_t count, std::size_t n) {
  return count < 2 ? n - 1 : (k * (n - 1) + (count - 1) / 2) / (count - 1);
}

}  // namespace

RunningMean running_mean(std::span<const double> sample, double confidence, std::size_t points) {
  RunningMean result;
  const std::size_t count = std::min(points, sample.size());
  double centre = 0.0, squares = 0.0;
  std::size_t used = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t wanted = spaced(k, count, sample.size()) + 1;
    while (used < wanted) {
      const double d = sample[used] - centre;
      ++used;
      centre += d / static_cast<double>(used);
      squares += d * (sample[used - 1] - centre);
    }
    Estimate estimate{centre, not_a_number, not_a_number};
    if (used >= 2) {
      const auto n = static_cast<double>(used);
      const double reach =
          student_t(confidence, static_cast<int>(used) - 1) * std::sqrt(squares / (n - 1.0) / n);
      estimate.low = centre - reach;
      estimate.high = centre + reach;
    }
    result.n.push_back(used);
    result.mean.push_back(estimate);
  }
  return result;
}

ExceedanceCurve exceedance_curve(std::span<const double> ascending, double confidence, std::size_t points) {
  std::vector<std::size_t> last;  // rank of the last of each run of equal values
  for (std::size_t k = 0; k < ascending.size(); ++k)
    if (k + 1 == ascending.size() || ascending[k + 1] != ascending[k]) last.push_back(k);
  ExceedanceCurve result;
  const std::size_t count = std::min(points, last.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t rank = last[spaced(k, count, last.size())];
    result.value.push_back(ascending[rank]);
    result.above.push_back(proportion(ascending.size() - 1 - rank, ascending.size(), confidence));
  }
  return result;
}

}  // namespace keyblock::statistics
