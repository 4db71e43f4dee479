#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "rockmass/joint_set.h"

namespace keyblock::verification {

/// Distribution function of a length cut off at zero, written apart from rockmass::quantile.
inline double reference_cdf(const rockmass::Distribution& d, double x) {
  const auto phi = [](double z) { return 0.5 * (1.0 + std::erf(z / std::sqrt(2.0))); };
  if (x <= 0.0) return 0.0;
  using enum rockmass::DistributionKind;
  switch (d.kind) {
    case constant:
      return x < d.mean ? 0.0 : 1.0;
    case uniform: {
      const double low = std::max(0.0, d.mean - std::sqrt(3.0) * d.std),
                   high = d.mean + std::sqrt(3.0) * d.std;
      return std::clamp((x - low) / (high - low), 0.0, 1.0);
    }
    case normal: {
      const double below = phi(-d.mean / d.std);
      return (phi((x - d.mean) / d.std) - below) / (1.0 - below);
    }
    case lognormal: {
      const double sigma = std::sqrt(std::log(1.0 + d.std * d.std / (d.mean * d.mean)));
      return phi((std::log(x / d.mean) + 0.5 * sigma * sigma) / sigma);
    }
    case exponential:
      return 1.0 - std::exp(-x / d.mean);
  }
  return 0.0;
}

/// Largest distance between the empirical and the reference distribution, times √n (Kolmogorov & Smirnov).
/// Above 1.63 with a probability of 1 %, above 1.95 of 0.1 %.
inline double kolmogorov_smirnov(std::vector<double> sample, const rockmass::Distribution& d) {
  std::sort(sample.begin(), sample.end());
  const auto n = static_cast<double>(sample.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < sample.size(); ++k) {
    const double p = reference_cdf(d, sample[k]);
    largest = std::max({largest, p - static_cast<double>(k) / n, static_cast<double>(k + 1) / n - p});
  }
  return largest * std::sqrt(n);
}

}  // namespace keyblock::verification
