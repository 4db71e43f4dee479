#include "statistics/bootstrap.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "statistics/distributions.h"
#include "statistics/sample.h"

namespace keyblock::statistics {

namespace {

bool usable(const std::vector<double>& replicates) {
  return !replicates.empty() &&
         std::none_of(replicates.begin(), replicates.end(), [](double x) { return std::isnan(x); });
}

/// Like quantile, but exact between equal values, infinite ones too.
double replicate_quantile(const std::vector<double>& ascending, double p) {
  const double h = static_cast<double>(ascending.size() - 1) * p;
  const double below = ascending[static_cast<std::size_t>(h)];
  const double above = ascending[std::min(static_cast<std::size_t>(h) + 1, ascending.size() - 1)];
  if (below == above) return below;
  if (std::isinf(below) || std::isinf(above)) return h - std::floor(h) < 0.5 ? below : above;
  return below + (h - std::floor(h)) * (above - below);
}

double acceleration(std::span<const double> left_out) {
  const double centre = mean(left_out);
  double squares = 0.0, cubes = 0.0;
  for (const double x : left_out) {
    const double d = centre - x;
    squares += d * d;
    cubes += d * d * d;
  }
  return cubes / (6.0 * std::pow(squares, 1.5));
}

/// Means with one value left out, and the same of standard deviations, from sums over all.
std::vector<double> means_without_one(std::span<const double> sample, double centre) {
  const auto n = static_cast<double>(sample.size());
  std::vector<double> result(sample.size());
  for (std::size_t i = 0; i < sample.size(); ++i) result[i] = centre - (sample[i] - centre) / (n - 1.0);
  return result;
}

std::vector<double> deviations_without_one(std::span<const double> sample, double centre, double deviation) {
  const auto n = static_cast<double>(sample.size());
  const double squares = (n - 1.0) * deviation * deviation;
  std::vector<double> result(sample.size());
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double d = sample[i] - centre;
    result[i] = std::sqrt(std::max(0.0, squares - n / (n - 1.0) * d * d) / (n - 2.0));
  }
  return result;
}

Estimate with(double value, Interval interval) {
  return {value, interval.low, interval.high};
}

}  // namespace

Resamples::Resamples(std::size_t n, std::size_t count) : n_(n), count_(count), ranks_(n * count) {
  std::vector<std::uint32_t> times(n);
  for (std::size_t r = 0; r < count; ++r) {
    const RandomStream stream(bootstrap_key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(n), 0);
    std::fill(times.begin(), times.end(), 0);
    for (std::size_t k = 0; k < n; ++k) {
      const double u = stream.uniform(static_cast<std::uint32_t>(k));
      ++times[std::min(n - 1, static_cast<std::size_t>(u * static_cast<double>(n)))];
    }
    auto* out = ranks_.data() + r * n;
    for (std::size_t i = 0; i < n; ++i) out = std::fill_n(out, times[i], static_cast<std::uint32_t>(i));
  }
}

Interval percentile_interval(std::vector<double>& replicates, double confidence) {
  if (!usable(replicates)) return {};
  std::sort(replicates.begin(), replicates.end());
  return {replicate_quantile(replicates, 0.5 * (1.0 - confidence)),
          replicate_quantile(replicates, 0.5 * (1.0 + confidence))};
}

Interval bca_interval(std::vector<double>& replicates, double estimate, std::span<const double> left_out,
                      double confidence) {
  if (!usable(replicates)) return {};
  std::sort(replicates.begin(), replicates.end());
  const auto [first, last] = std::equal_range(replicates.begin(), replicates.end(), estimate);
  const double share =
      (static_cast<double>(first - replicates.begin()) + 0.5 * static_cast<double>(last - first)) /
      static_cast<double>(replicates.size());
  const double z_0 = inverse_normal_cdf(share);
  const double a = acceleration(left_out);
  if (!std::isfinite(z_0) || !std::isfinite(a)) return percentile_interval(replicates, confidence);
  const auto end = [&](double p) {
    const double z = z_0 + inverse_normal_cdf(p);
    return replicate_quantile(replicates, normal_cdf(z_0 + z / (1.0 - a * z)));
  };
  return {end(0.5 * (1.0 - confidence)), end(0.5 * (1.0 + confidence))};
}

Description describe(std::span<const double> ascending, std::span<const double> probabilities,
                     const Resamples& resamples, double confidence) {
  Description result;
  result.n = ascending.size();
  result.mean.value = mean(ascending);
  result.standard_deviation.value = standard_deviation(ascending);
  for (const double p : probabilities)
    result.quantiles.push_back({quantile(ascending, p), not_a_number, not_a_number});
  if (ascending.empty()) return result;
  result.min = ascending.front();
  result.max = ascending.back();
  if (result.n < smallest_bootstrap_sample) return result;

  const double centre = result.mean.value;
  const auto n = static_cast<double>(result.n);
  std::vector<double> means(resamples.count()), deviations(resamples.count());
  std::vector<std::vector<double>> quantiles(probabilities.size(), std::vector<double>(resamples.count()));
  for (std::size_t r = 0; r < resamples.count(); ++r) {
    const auto ranks = resamples.ranks(r);
    double sum = 0.0, squares = 0.0;
    // From a value of the resample, so that one of equal values has no spread by rounding.
    const double first = ascending[ranks.front()];
    for (const std::uint32_t k : ranks) sum += ascending[k] - first;
    means[r] = first + sum / n;
    for (const std::uint32_t k : ranks) squares += (ascending[k] - means[r]) * (ascending[k] - means[r]);
    deviations[r] = std::sqrt(squares / (n - 1.0));
    for (std::size_t q = 0; q < probabilities.size(); ++q) {
      const double h = (n - 1.0) * probabilities[q];
      const auto below = static_cast<std::size_t>(h);
      const double x = ascending[ranks[below]];
      const double y = ascending[ranks[std::min(below + 1, ranks.size() - 1)]];
      quantiles[q][r] = x + (h - static_cast<double>(below)) * (y - x);
    }
  }
  result.mean = with(centre, bca_interval(means, centre, means_without_one(ascending, centre), confidence));
  const double deviation = result.standard_deviation.value;
  result.standard_deviation = with(
      deviation,
      bca_interval(deviations, deviation, deviations_without_one(ascending, centre, deviation), confidence));
  for (std::size_t q = 0; q < probabilities.size(); ++q)
    result.quantiles[q] = with(result.quantiles[q].value, percentile_interval(quantiles[q], confidence));
  return result;
}

}  // namespace keyblock::statistics
