#pragma once
#include <cmath>
#include <vector>

namespace keyblock::rockmass {

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
