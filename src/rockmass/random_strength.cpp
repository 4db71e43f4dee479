#include "rockmass/random_strength.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/random.h"
#include "rockmass/distribution.h"

namespace keyblock::rockmass {
namespace {

/// Random streams of traces (trace_generator.cpp) have the number of the set alone in this word.
constexpr std::uint32_t first_strength_bit = 16;
constexpr std::uint32_t of_maps = 1u << 15;
/// No realization, and no interval of a line, has this number.
constexpr std::uint32_t no_number = 0xffffffffu;

/// Whose draw a strength has.
StrengthKey peak_of(StrengthKey key) {
  if (key == StrengthKey::residual_friction) return StrengthKey::friction;
  return key == StrengthKey::residual_cohesion ? StrengthKey::cohesion : key;
}

std::uint32_t stream_word(TraceSource source, StrengthKey key) {
  const std::uint32_t kind = source.kind == TraceSource::Kind::trace_map ? of_maps : 0u;
  return ((static_cast<std::uint32_t>(key) + 1u) << first_strength_bit) | kind |
         static_cast<std::uint32_t>(source.index);
}

double normal_below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// Of ln x.
struct LogNormal {
  double mean, deviation;
  explicit LogNormal(const Distribution& d) {
    const double variance = std::log1p((d.std / d.mean) * (d.std / d.mean));
    deviation = std::sqrt(variance);
    mean = std::log(d.mean) - 0.5 * variance;
  }
};

bool varies(const Distribution& d) {
  return d.kind == DistributionKind::exponential || (d.kind != DistributionKind::constant && d.std > 0.0);
}

/// F₀(x)
double share_below(const Distribution& d, double x) {
  switch (d.kind) {
    case DistributionKind::uniform:
      return std::clamp(0.5 + (x - d.mean) / (2.0 * std::numbers::sqrt3 * d.std), 0.0, 1.0);
    case DistributionKind::normal:
      return normal_below((x - d.mean) / d.std);
    case DistributionKind::lognormal: {
      const LogNormal log(d);
      return x > 0.0 ? normal_below((std::log(x) - log.mean) / log.deviation) : 0.0;
    }
    case DistributionKind::exponential:
      return x > 0.0 ? -std::expm1(-x / d.mean) : 0.0;
    case DistributionKind::constant:
      break;
  }
  return x < d.mean ? 0.0 : 1.0;
}

/// x with F₀(x) = p. quantile() cuts off what is below zero; here `min` and `max` say where.
double place_of(const Distribution& d, double p) {
  if (d.kind == DistributionKind::uniform) return d.mean + (2.0 * p - 1.0) * std::numbers::sqrt3 * d.std;
  if (d.kind == DistributionKind::normal) return d.mean + d.std * inverse_normal_cdf(p);
  return quantile(d, p);  // nothing is below zero
}

double rounded(double x) {
  constexpr int digits = 40;
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(fraction, digits)), exponent - digits);
}

/// π(r)
std::uint32_t stratum_of(const Sampling& sampling, std::uint32_t word) {
  const auto n = static_cast<std::size_t>(sampling.strata);
  const RandomStream stream(sampling.seed, no_number, word, static_cast<std::uint32_t>(n));
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  for (std::size_t k = n - 1; k > 0; --k) {  // Fisher & Yates
    const double u = stream.uniform(static_cast<std::uint32_t>(k));
    std::swap(order[k], order[std::min(k, static_cast<std::size_t>(u * static_cast<double>(k + 1)))]);
  }
  return order[static_cast<std::size_t>(sampling.realization)];
}

}  // namespace

double RandomStrength::kept() const {
  if (!varies(distribution)) return 1.0;
  return share_below(distribution, max) - share_below(distribution, min);
}

double RandomStrength::quantile(double u) const {
  if (!varies(distribution)) return distribution.mean;
  const double low = share_below(distribution, min), high = share_below(distribution, max);
  return std::clamp(rounded(place_of(distribution, std::lerp(low, high, u))), min, max);
}

double RandomStrength::truncated_mean() const {
  constexpr int parts = 4096;
  if (!varies(distribution)) return distribution.mean;
  double sum = 0.0;
  for (int k = 0; k < parts; ++k) sum += quantile((k + 0.5) / parts);
  return sum / parts;
}

double uniform_of(const Sampling& sampling, const Trace& trace, StrengthKey key, DrawnPer per) {
  const std::uint32_t word = stream_word(trace.source, peak_of(key));
  const std::uint32_t line = per == DrawnPer::realization ? 0u : trace.line,
                      interval = per == DrawnPer::joint ? trace.interval : no_number;
  const auto realization = static_cast<std::uint32_t>(sampling.realization);
  const double u = RandomStream(sampling.seed, realization, word, line).uniform(interval);
  if (per != DrawnPer::realization || sampling.realization >= sampling.strata) return u;
  return (stratum_of(sampling, word) + u) / sampling.strata;
}

}  // namespace keyblock::rockmass
