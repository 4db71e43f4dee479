#include "statistics/sample.h"

#include <algorithm>
#include <cmath>

#include "statistics/interval.h"

namespace keyblock::statistics {

double mean(std::span<const double> sample) {
  if (sample.empty()) return not_a_number;
  double sum = 0.0;
  for (const double x : sample) sum += x - sample.front();
  return sample.front() + sum / static_cast<double>(sample.size());
}

double standard_deviation(std::span<const double> sample) {
  if (sample.size() < 2) return not_a_number;
  const double centre = mean(sample);
  double squares = 0.0;
  for (const double x : sample) squares += (x - centre) * (x - centre);
  return std::sqrt(squares / static_cast<double>(sample.size() - 1));
}

double quantile(std::span<const double> ascending, double p) {
  if (ascending.empty()) return not_a_number;
  const double h = static_cast<double>(ascending.size() - 1) * std::clamp(p, 0.0, 1.0);
  const auto below = static_cast<std::size_t>(h);
  if (below + 1 >= ascending.size()) return ascending.back();
  const double share = h - static_cast<double>(below);
  return ascending[below] + share * (ascending[below + 1] - ascending[below]);
}

}  // namespace keyblock::statistics
