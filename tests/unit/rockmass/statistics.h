#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "rockmass/joint_set.h"

namespace keyblock::rockmass {

/// Distribution function of a length cut off at zero, written apart from quantile().
inline double reference_cdf(const Distribution& d, double x) {
  const auto normal = [](double z) { return 0.5 * (1.0 + std::erf(z / std::sqrt(2.0))); };
  if (x <= 0.0) return 0.0;
  switch (d.kind) {
    case DistributionKind::constant:
      return x < d.mean ? 0.0 : 1.0;
    case DistributionKind::uniform: {
      const double low = std::max(0.0, d.mean - std::sqrt(3.0) * d.std),
                   high = d.mean + std::sqrt(3.0) * d.std;
      return std::clamp((x - low) / (high - low), 0.0, 1.0);
    }
    case DistributionKind::normal: {
      const double below = normal(-d.mean / d.std);
      return (normal((x - d.mean) / d.std) - below) / (1.0 - below);
    }
    case DistributionKind::lognormal: {
      const double sigma = std::sqrt(std::log(1.0 + d.std * d.std / (d.mean * d.mean)));
      return normal((std::log(x / d.mean) + 0.5 * sigma * sigma) / sigma);
    }
    case DistributionKind::exponential:
      return 1.0 - std::exp(-x / d.mean);
  }
  return 0.0;
}

/// Largest distance between the empirical and the reference distribution, times √n (Kolmogorov & Smirnov).
/// Above 1.63 with a probability of 1 %, above 1.95 of 0.1 %.
inline double kolmogorov_smirnov(std::vector<double> sample, const Distribution& d) {
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < sample.size(); ++k) {
    const double p = reference_cdf(d, sample[k]);
    largest = std::max({largest, p - static_cast<double>(k) / n, static_cast<double>(k + 1) / n - p});
  }
  return largest * std::sqrt(n);
}

/// Mean and its standard error.
struct Estimate {
  double mean = 0.0;
  double error = 0.0;

  explicit Estimate(const std::vector<double>& sample) {
    const auto n = static_cast<double>(sample.size());
    for (const double x : sample) mean += x / n;
    double squares = 0.0;
    for (const double x : sample) squares += (x - mean) * (x - mean);
    error = std::sqrt(squares / (n - 1.0) / n);
  }
};

}  // namespace keyblock::rockmass
