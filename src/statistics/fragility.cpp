#include "statistics/fragility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "core/random.h"
#include "statistics/distributions.h"
#include "statistics/fragility_table.h"

namespace keyblock::statistics {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Fisher scoring ends when a step is below this, in units of η.
constexpr double step_tolerance = 1e-9;
constexpr int most_steps = 200, most_halvings = 40;
/// Beyond, Φ and its complement are at the end of the floating-point range.
constexpr double largest_eta = 35.0;

/// η = a + b (x − centre), x = ln intensity.
struct Probit {
  double a = 0.0, b = 0.0;
};

struct Row {
  double x, n, z;
};

/// ln L at a line, its score s = Σ (z − n p) φ/(p q) (1, x) and its information I = Σ n φ²/(p q) (1, x)(1, x)ᵀ.
struct Evaluation {
  double log_likelihood = 0.0;
  double s_0 = 0.0, s_1 = 0.0, i_00 = 0.0, i_01 = 0.0, i_11 = 0.0;
};

Evaluation evaluate(std::span<const Row> rows, Probit line) {
  Evaluation e;
  for (const Row& row : rows) {
    const double eta = std::clamp(line.a + line.b * row.x, -largest_eta, largest_eta);
    // The smaller of both tails by erfc, the other as its complement.
    const double tail = normal_cdf(-std::abs(eta));
    const double p = eta < 0.0 ? tail : 1.0 - tail;
    const double q = eta < 0.0 ? 1.0 - tail : tail;
    const double density = std::exp(-0.5 * eta * eta) / std::sqrt(2.0 * std::numbers::pi);
    if (row.z > 0.0) e.log_likelihood += row.z * std::log(p);
    if (row.z < row.n) e.log_likelihood += (row.n - row.z) * std::log(q);
    const double residual = (row.z * q - (row.n - row.z) * p) * (density / p) / q;
    const double weight = row.n * (density / p) * (density / q);
    e.s_0 += residual;
    e.s_1 += residual * row.x;
    e.i_00 += weight;
    e.i_01 += weight * row.x;
    e.i_11 += weight * row.x * row.x;
  }
  return e;
}

/// The step I⁻¹ s of Fisher scoring.
Probit scoring_step(const Evaluation& e) {
  const double determinant = e.i_00 * e.i_11 - e.i_01 * e.i_01;
  if (!(determinant > 1e-14 * e.i_00 * e.i_11)) return e.i_00 > 0.0 ? Probit{e.s_0 / e.i_00, 0.0} : Probit{};
  return {(e.i_11 * e.s_0 - e.i_01 * e.s_1) / determinant, (e.i_00 * e.s_1 - e.i_01 * e.s_0) / determinant};
}

/// The most likely line, from any start; exists and is unique for data that are not separated.
Probit most_likely(std::span<const Row> rows, Probit line, double tolerance) {
  Evaluation here = evaluate(rows, line);
  double reach = 0.0;
  for (const Row& row : rows) reach = std::max(reach, std::abs(row.x));
  for (int k = 0; k < most_steps; ++k) {
    Probit step = scoring_step(here);
    if (std::abs(step.a) + reach * std::abs(step.b) < tolerance) break;
    bool better = false;
    for (int halving = 0; halving < most_halvings && !better; ++halving) {
      const Probit next{line.a + step.a, line.b + step.b};
      const Evaluation there = evaluate(rows, next);
      better = there.log_likelihood >= here.log_likelihood;
      if (better) {
        line = next;
        here = there;
      }
      step = {0.5 * step.a, 0.5 * step.b};
    }
    if (!better) break;  // at rounding: no step goes up any more
  }
  return line;
}

struct Ends {
  double first_exceeded = infinity, last_exceeded = 0.0;  ///< intensities with some z > 0
  double first_spared = infinity, last_spared = 0.0;      ///< with some z < n
  double first = infinity, last = 0.0;
  double n = 0.0, z = 0.0;
};

Ends ends_of(std::span<const Stripe> stripes) {
  Ends ends;
  for (const Stripe& s : stripes) {
    if (!(s.runs > 0.0)) continue;
    ends.n += s.runs;
    ends.z += s.exceeded;
    ends.first = std::min(ends.first, s.intensity);
    ends.last = std::max(ends.last, s.intensity);
    if (s.exceeded > 0.0) {
      ends.first_exceeded = std::min(ends.first_exceeded, s.intensity);
      ends.last_exceeded = std::max(ends.last_exceeded, s.intensity);
    }
    if (s.exceeded < s.runs) {
      ends.first_spared = std::min(ends.first_spared, s.intensity);
      ends.last_spared = std::max(ends.last_spared, s.intensity);
    }
  }
  return ends;
}

}  // namespace

const char* name_of(FragilityStatus status) {
  switch (status) {
    case FragilityStatus::fitted:
      return "fitted";
    case FragilityStatus::no_data:
      return "no_data";
    case FragilityStatus::one_intensity:
      return "one_intensity";
    case FragilityStatus::never_exceeded:
      return "never_exceeded";
    case FragilityStatus::always_exceeded:
      return "always_exceeded";
    case FragilityStatus::separated:
      return "separated";
    case FragilityStatus::not_increasing:
      return "not_increasing";
    case FragilityStatus::exceeded_at_rest:
      return "exceeded_at_rest";
    case FragilityStatus::too_few_clusters:
      return "too_few_realizations";
    case FragilityStatus::few_fits:
      return "few_fits";
    case FragilityStatus::wide_theta:
      return "wide_theta";
    case FragilityStatus::wide_beta:
      return "wide_beta";
  }
  return "";
}

double FragilityFit::probability(double intensity) const {
  switch (status) {
    case FragilityStatus::fitted:
      return intensity > 0.0 ? normal_cdf(std::log(intensity / theta) / beta) : 0.0;
    case FragilityStatus::separated:
      return intensity < theta ? 0.0 : intensity > theta ? 1.0 : 0.5;
    case FragilityStatus::never_exceeded:
    case FragilityStatus::always_exceeded:
    case FragilityStatus::not_increasing:
      return share;
    default:
      return not_a_number;
  }
}

namespace {

/// `start`: a curve from which to go, where there is one.
FragilityFit fit_from(std::span<const Stripe> stripes, const FragilityFit* start, double tolerance) {
  FragilityFit fit;
  const Ends ends = ends_of(stripes);
  if (!(ends.n > 0.0)) return fit;
  fit.share = ends.z / ends.n;
  if (ends.z == 0.0 || ends.z == ends.n) {
    fit.status = ends.z == 0.0 ? FragilityStatus::never_exceeded : FragilityStatus::always_exceeded;
    fit.theta = ends.z == 0.0 ? infinity : 0.0;
    return fit;
  }
  if (ends.first == ends.last) {
    fit.status = FragilityStatus::one_intensity;
    return fit;
  }
  if (ends.last_spared <= ends.first_exceeded) {
    fit.status = FragilityStatus::separated;
    fit.theta = std::sqrt(ends.last_spared * ends.first_exceeded);
    fit.beta = 0.0;
    return fit;
  }
  fit.status = FragilityStatus::not_increasing;
  fit.theta = fit.share < 0.5 ? infinity : fit.share > 0.5 ? 0.0 : not_a_number;
  fit.beta = infinity;
  if (ends.last_exceeded <= ends.first_spared) return fit;

  const double centre = 0.5 * (std::log(ends.first) + std::log(ends.last));
  std::vector<Row> rows;
  for (const Stripe& s : stripes)
    if (s.runs > 0.0) rows.push_back({std::log(s.intensity) - centre, s.runs, s.exceeded});
  const Probit first = start != nullptr
                           ? Probit{(centre - std::log(start->theta)) / start->beta, 1.0 / start->beta}
                           : Probit{inverse_normal_cdf(fit.share), 0.0};
  const Probit line = most_likely(rows, first, tolerance);
  // A slope that is rounding alone is none.
  if (!(line.b * (std::log(ends.last) - std::log(ends.first)) > 1e-8)) return fit;
  fit.status = FragilityStatus::fitted;
  fit.beta = 1.0 / line.b;
  fit.theta = std::exp(centre - line.a / line.b);
  return fit;
}

template <class Key>
std::vector<FragilityFit> fits_without(const FragilityTable& table,
                                       const std::map<Key, FragilityParts>& groups,
                                       const FragilityFit& whole) {
  std::vector<FragilityFit> fits;
  std::vector<Stripe> stripes = table.stripes;
  for (const auto& [key, parts] : groups) {
    for (const FragilityPart& part : parts) {
      stripes[part.stripe].runs -= part.runs;
      stripes[part.stripe].exceeded -= part.exceeded;
    }
    fits.push_back(fit_from(stripes, &whole, step_tolerance));
    for (const FragilityPart& part : parts) stripes[part.stripe] = table.stripes[part.stripe];
  }
  return fits;
}

FragilityRefits refitted(const FragilityTable& table, const FragilityFit& whole) {
  FragilityRefits refits{fits_without(table, table.clusters, whole), {}, {}};
  if (table.records.size() < 2) return refits;
  refits.records = fits_without(table, table.records, whole);
  refits.pairs = fits_without(table, table.pairs, whole);
  return refits;
}

double log_theta(const FragilityFit& fit) {
  return fit.status == FragilityStatus::fitted ? std::log(fit.theta) : not_a_number;
}

double log_beta(const FragilityFit& fit) {
  return fit.status == FragilityStatus::fitted ? std::log(fit.beta) : not_a_number;
}

template <class Of>
Estimate interval_of(const FragilityCurve& curve, const Of& of, double confidence) {
  return two_way_interval(of(curve.fit), curve.refits.numbers(of), confidence);
}

Estimate exponential(const Estimate& e) {
  return {std::exp(e.value), std::exp(e.low), std::exp(e.high)};
}

Estimate probability_of(const Estimate& eta) {
  const auto of = [](double x) { return std::isnan(x) ? not_a_number : normal_cdf(x); };
  return {of(eta.value), of(eta.low), of(eta.high)};
}

bool spans_more(const Estimate& e, double factor) {
  return !(e.low > 0.0 && e.high <= factor * e.low);
}

/// Whether the fit is a curve to be shown; its intervals are there by now.
FragilityStatus judged(const FragilityCurve& curve, const FragilityLimits& limits) {
  const FragilityStatus status = curve.fit.status;
  const bool one_curve = status == FragilityStatus::fitted || status == FragilityStatus::separated ||
                         status == FragilityStatus::not_increasing;
  if (one_curve && curve.at_rest.exceeded > limits.share_at_rest * curve.at_rest.runs)
    return FragilityStatus::exceeded_at_rest;
  if (status != FragilityStatus::fitted) return status;
  if (curve.clusters < smallest_bootstrap_sample) return FragilityStatus::too_few_clusters;
  const auto has_none = [](const FragilityFit& fit) { return fit.status != FragilityStatus::fitted; };
  if (std::ranges::any_of(curve.refits.rocks, has_none) ||
      std::ranges::any_of(curve.refits.records, has_none))
    return FragilityStatus::few_fits;
  if (spans_more(curve.theta, limits.widest_theta)) return FragilityStatus::wide_theta;
  if (spans_more(curve.beta, limits.widest_beta)) return FragilityStatus::wide_beta;
  return status;
}

}  // namespace

FragilityFit fit_fragility(std::span<const Stripe> stripes) {
  return fit_from(stripes, nullptr, step_tolerance);
}

FragilityCurve fragility_curve(std::span<const Observation> runs, std::span<const double> at,
                               double confidence, const FragilityLimits& limits) {
  const FragilityTable table = tabulate(runs);
  FragilityCurve curve;
  curve.stripes = table.stripes;
  curve.clusters = table.clusters.size();
  curve.records = table.records.size();
  curve.at_rest = table.at_rest;
  curve.fit = fit_fragility(table.stripes);
  const ShakenPairs shaken = shaken_pairs(table);
  curve.pairs = shaken.pairs.size();
  curve.not_monotone = shaken.not_monotone;
  if (curve.fit.status == FragilityStatus::fitted) {
    curve.theta.value = curve.fit.theta;
    curve.beta.value = curve.fit.beta;
    if (curve.clusters >= smallest_bootstrap_sample) {
      curve.refits = refitted(table, curve.fit);
      curve.theta = exponential(interval_of(curve, log_theta, confidence));
      curve.beta = exponential(interval_of(curve, log_beta, confidence));
    }
  }
  curve.status = judged(curve, limits);
  if (curve.status != FragilityStatus::fitted) return curve;
  curve.split = split_of(table, curve, shaken, confidence);
  curve.intensity.assign(at.begin(), at.end());
  for (const double x : at) {
    const auto eta = [&](const FragilityFit& fit) { return (std::log(x) - log_theta(fit)) / fit.beta; };
    curve.probability.push_back(probability_of(interval_of(curve, eta, confidence)));
  }
  return curve;
}

}  // namespace keyblock::statistics
