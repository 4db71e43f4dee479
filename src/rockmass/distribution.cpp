#include "rockmass/distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace keyblock::rockmass {

namespace {

struct Interval {
  double low, high;
};

Interval uniform_range(const Distribution& d) {
  const double half = std::numbers::sqrt3 * d.std;
  return {std::max(0.0, d.mean - half), d.mean + half};
}

/// Normal probability above z.
double upper_tail(double z) {
  return 0.5 * std::erfc(z / std::numbers::sqrt2);
}

double normal_quantile(const Distribution& d, double u) {
  // From the upper end: no digits are lost when nearly nothing is cut off.
  const double kept = upper_tail(-d.mean / d.std);
  const double z = -inverse_normal_cdf(kept * (1.0 - u));
  return std::max(0.0, d.mean + d.std * z);
}

}  // namespace

double quantile(const Distribution& d, double u) {
  if (d.kind != DistributionKind::exponential && d.std == 0.0) return d.mean;
  switch (d.kind) {
    case DistributionKind::constant:
      return d.mean;
    case DistributionKind::uniform: {
      const Interval range = uniform_range(d);
      return range.low + u * (range.high - range.low);
    }
    case DistributionKind::normal:
      return normal_quantile(d, u);
    case DistributionKind::lognormal: {
      const double variance = std::log1p((d.std / d.mean) * (d.std / d.mean));
      return d.mean * std::exp(std::sqrt(variance) * inverse_normal_cdf(u) - 0.5 * variance);
    }
    case DistributionKind::exponential:
      return -d.mean * std::log1p(-u);
  }
  return d.mean;
}

double truncated_mean(const Distribution& d) {
  if (d.std == 0.0) return d.mean;
  if (d.kind == DistributionKind::uniform) {
    const Interval range = uniform_range(d);
    return 0.5 * (range.low + range.high);
  }
  if (d.kind == DistributionKind::normal) {
    const double z = d.mean / d.std;
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    return d.mean + d.std * density / upper_tail(-z);
  }
  return d.mean;
}

}  // namespace keyblock::rockmass
