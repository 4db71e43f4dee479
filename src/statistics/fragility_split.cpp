#include <algorithm>
#include <cmath>
#include <iterator>

#include "statistics/fragility_table.h"

namespace keyblock::statistics {

namespace {

std::vector<double> thresholds_of(const FragilityTable& table, const FragilityFit& fit) {
  std::vector<double> thresholds;
  for (const Stripe& s : table.stripes) thresholds.push_back(std::log(s.intensity / fit.theta) / fit.beta);
  return thresholds;
}

/// σ² of rock, record and rest.
struct Variances {
  double rock, record, rest;
};

Variances variances_of(const FragilityFit& fit, const SharedCorrelations& rho) {
  const double all = fit.beta * fit.beta;
  return {rho.rock * all, rho.record * all, (1.0 - rho.rock - rho.record) * all};
}

/// The variances without one rock mass, record or pair: `left_out` tells of a pair whether it is.
template <class IsOut>
Variances variances_without(const FragilityTable& table, const std::vector<Pair>& pairs,
                            const FragilityFit& fit, const SharedCorrelations& start, const IsOut& is_out) {
  std::vector<Pair> others;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(others),
               [&](const Pair& pair) { return !is_out(pair); });
  return variances_of(fit, near_correlations(others, thresholds_of(table, fit), start));
}

Estimate deviation(double variance, const LeftOut& without, double confidence) {
  const Estimate e = two_way_interval(variance, without, confidence);
  const auto root = [](double x) { return std::isnan(x) ? x : std::sqrt(std::max(x, 0.0)); };
  return {root(e.value), root(e.low), root(e.high)};
}

}  // namespace

Split split_of(const FragilityTable& table, const FragilityCurve& curve, const ShakenPairs& shaken,
               double confidence) {
  const std::vector<Pair>& pairs = shaken.pairs;
  if (table.clusters.size() < smallest_split_rocks || table.records.size() < smallest_split_records ||
      !shaken.complete)
    return {};
  const SharedCorrelations rho = shared_correlations(pairs, thresholds_of(table, curve.fit));
  if (std::isnan(rho.rock) || std::isnan(rho.record)) return {};
  std::vector<Variances> rocks, records;
  std::size_t k = 0;
  for (const auto& [id, parts] : table.clusters)
    rocks.push_back(variances_without(table, pairs, curve.refits.rocks[k++], rho,
                                      [rock = id](const Pair& pair) { return pair.rock == rock; }));
  k = 0;
  for (const auto& [id, parts] : table.records)
    records.push_back(variances_without(table, pairs, curve.refits.records[k++], rho,
                                        [record = id](const Pair& pair) { return pair.record == record; }));
  const Variances whole = variances_of(curve.fit, rho);
  const auto estimated = [&](double Variances::*part) {
    const auto each = [&](const std::vector<Variances>& all) {
      std::vector<double> values;
      for (const Variances& v : all) values.push_back(v.*part);
      return values;
    };
    return deviation(whole.*part, {each(rocks), each(records), {}}, confidence);
  };
  return {estimated(&Variances::rock), estimated(&Variances::record), estimated(&Variances::rest)};
}

}  // namespace keyblock::statistics
